#pragma once

#include <cstdint>

namespace voxlist {

class Bus;
class Health;

struct CloudAssemblerConfig {
  template <class Visitor>
  void visit(Visitor&) {}
};

class CloudAssemblerService {
 public:
  CloudAssemblerService(Bus&, Health&, const CloudAssemblerConfig&) {}
};

}  // namespace voxlist
