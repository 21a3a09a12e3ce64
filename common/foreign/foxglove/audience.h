#pragma once

#include <cstdint>
#include <string>

#include "voxlist/foreign/foxglove/messages.h"

namespace voxlist::foreign {

/// A stream of messages of one kind.
struct Topic {
  std::string name;
  Kind kind;

  auto operator<=>(const Topic&) const = default;
};

/// Who is told what the bus says: a file, or viewers.
class Audience {
 public:
  virtual ~Audience() = default;

  /// Whether anybody looks at it now: asked before something large is made. A topic that nobody has
  /// heard of is known from then on.
  virtual bool wants(const Topic& topic) = 0;

  /// An encoded message; `utime_us` is its data's.
  virtual void tell(const Topic& topic, std::int64_t utime_us, std::string bytes) = 0;
};

}  // namespace voxlist::foreign
