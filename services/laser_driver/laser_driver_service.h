#pragma once

#include <cstdint>

namespace voxlist {

class Bus;
class Health;

struct LaserDriverConfig {
  template <class Visitor>
  void visit(Visitor&) {}
};

class LaserDriverService {
 public:
  LaserDriverService(Bus&, Health&, const LaserDriverConfig&) {}
};

}  // namespace voxlist
