#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace voxlist::bus {

/// Runs a disabled test of this program in a private network; its exit code, 0 when it passed.
/// `setup`: shell commands before it, each with && behind it.
inline int run_in_private_network(const std::string& setup, const std::string& test) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "unshare -rn sh -c '" + setup + " " + self +
                              " --gtest_also_run_disabled_tests --gtest_filter=" + test + "'";
  return std::system(command.c_str());
}

/// Makes LCM's multicast work there.
inline constexpr char kWithMulticast[] = "ip link set lo up && ip route add 224.0.0.0/4 dev lo &&";

inline bool has_private_networks() {
  return std::system("unshare -rn sh -c 'ip link set lo up' 2>/dev/null") == 0;
}

}  // namespace voxlist::bus
