#include "voxlist/serial/line_speed.h"

#include <array>
#include <utility>

namespace voxlist::serial {
namespace {

constexpr std::array<std::pair<int, speed_t>, 14> kSpeeds{{{1200, B1200},
                                                           {2400, B2400},
                                                           {4800, B4800},
                                                           {9600, B9600},
                                                           {19200, B19200},
                                                           {38400, B38400},
                                                           {57600, B57600},
                                                           {115200, B115200},
                                                           {230400, B230400},
                                                           {460800, B460800},
                                                           {500000, B500000},
                                                           {921600, B921600},
                                                           {1000000, B1000000},
                                                           {2000000, B2000000}}};

}  // namespace

std::optional<speed_t> line_speed(int baud) {
  for (const auto& [number, speed] : kSpeeds)
    if (number == baud) return speed;
  return std::nullopt;
}

int baud_of(speed_t speed) {
  for (const auto& [number, code] : kSpeeds)
    if (code == speed) return number;
  return 0;
}

void make_raw(termios& settings) {
  cfmakeraw(&settings);
  settings.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cc[VMIN] = 1;  // with O_NONBLOCK: 0 bytes mean that the line is gone
  settings.c_cc[VTIME] = 0;
}

}  // namespace voxlist::serial
