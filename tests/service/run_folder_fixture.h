#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace voxlist::service {

/// Gives each test a run folder of its own, and takes it away again.
class WithRunFolder : public ::testing::Test {
 protected:
  WithRunFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "service_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    setenv("VOXLIST_RUN_DIR", folder_.c_str(), 1);
    unsetenv("LCM_DEFAULT_URL");
  }
  ~WithRunFolder() override {
    unsetenv("VOXLIST_RUN_DIR");
    unsetenv("LCM_DEFAULT_URL");
    std::filesystem::remove_all(folder_);
  }

  std::filesystem::path folder_;
};

}  // namespace voxlist::service
