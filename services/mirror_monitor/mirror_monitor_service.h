#pragma once

#include <cstdint>

namespace voxlist {

class Bus;
class Health;

struct MirrorMonitorConfig {
  template <class Visitor>
  void visit(Visitor&) {}
};

class MirrorMonitorService {
 public:
  MirrorMonitorService(Bus&, Health&, const MirrorMonitorConfig&) {}
};

}  // namespace voxlist
