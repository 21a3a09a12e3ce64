// A disk that fails, for a program that is started with this library in LD_PRELOAD, while the file
// that FAILING_DISK names is there. With FAILING_DISK_SEED many writes to a keyframe file go wrong,
// each in one of the ways that disks have, in an order that follows from the seed; without it the
// disk is full.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <random>
#include <string>

namespace {

bool fails_now(int file) {
  const char* sign = std::getenv("FAILING_DISK");
  if (sign == nullptr || ::access(sign, F_OK) != 0) return false;
  char name[4096];
  const ssize_t size =
      ::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), name, sizeof name);
  return size > 0 &&
         std::string(name, static_cast<std::size_t>(size)).ends_with("keyframes.voxlist");
}

unsigned draw(unsigned from) {
  const char* seed = std::getenv("FAILING_DISK_SEED");
  static std::mt19937 random(seed != nullptr ? static_cast<unsigned>(std::atoi(seed)) : 0U);
  return static_cast<unsigned>(random() % from);
}

int failed(int error) {
  errno = error;
  return -1;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

// No room, a broken disk, a part that is written before either; now and then a part alone, which is
// no fault.
extern "C" ssize_t write(int file, const void* bytes, size_t count) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  if (!fails_now(file)) return real(file, bytes, count);
  if (std::getenv("FAILING_DISK_SEED") == nullptr) return failed(ENOSPC);
  switch (draw(6)) {
    case 0:
      return failed(ENOSPC);
    case 1:
      return failed(EIO);
    case 2:
    case 3:
      return real(file, bytes, count / 2 + 1);
    default:
      return real(file, bytes, count);
  }
}

extern "C" int fdatasync(int file) {
  static auto* const real = next<int(int)>("fdatasync");
  return fails_now(file) && draw(3) == 0 ? failed(EIO) : real(file);
}

// What was half written cannot be cut off again.
extern "C" int ftruncate(int file, off_t size) {
  static auto* const real = next<int(int, off_t)>("ftruncate");
  return fails_now(file) && draw(2) == 0 ? failed(EIO) : real(file, size);
}
