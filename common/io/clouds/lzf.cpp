#include "voxlist/io/clouds/lzf.h"

#include "voxlist/io/files/cursor.h"

namespace voxlist::io {
namespace {

// The densest input is a chain of 3-byte references that repeat 264 bytes each.
constexpr std::size_t kMaxRatio = 88;

class Input {
 public:
  explicit Input(std::string_view bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }

  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) {
      throw FormatError("ends inside its compressed data");
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::size_t take_byte() { return static_cast<unsigned char>(take(1).front()); }

 private:
  std::string_view bytes_;
};

void require(bool holds) {
  if (!holds) {
    throw FormatError("has damaged compressed data");
  }
}

}  // namespace

std::string unpack_lzf(std::string_view packed, std::size_t size) {
  require(size / kMaxRatio <= packed.size());
  std::string out;
  out.reserve(size);
  Input in(packed);
  while (!in.empty()) {
    const std::size_t control = in.take_byte();
    if (control < 32) {
      const std::string_view literals = in.take(control + 1);
      require(literals.size() <= size - out.size());
      out += literals;
      continue;
    }
    const std::size_t short_length = control >> 5;
    const std::size_t length = short_length + 2 + (short_length == 7 ? in.take_byte() : 0);
    const std::size_t distance = ((control & 31) << 8) + in.take_byte() + 1;
    require(distance <= out.size() && length <= size - out.size());
    // Byte by byte: a reference may overlap what it writes.
    for (std::size_t i = 0; i < length; ++i) {
      out.push_back(out[out.size() - distance]);
    }
  }
  require(out.size() == size);
  return out;
}

}  // namespace voxlist::io
