// To be preloaded: the program's wall clock is SHIFTED_CLOCK_S seconds ahead (or behind, below 0).
// Clocks that only run forward stay as they are.
#include <dlfcn.h>
#include <sys/time.h>

#include <cstdlib>
#include <ctime>

namespace {

long shift_s() {
  static const long shift = [] {
    const char* text = std::getenv("SHIFTED_CLOCK_S");
    return text != nullptr ? std::atol(text) : 0;
  }();
  return shift;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Function = int (*)(clockid_t, timespec*);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int result = next(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += shift_s();
  return result;
}

// liblcm takes the times of arrival from this one.
extern "C" int gettimeofday(timeval* time, void* zone) noexcept {
  using Function = int (*)(timeval*, void*);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "gettimeofday"));
  const int result = next(time, zone);
  if (result == 0) time->tv_sec += shift_s();
  return result;
}
