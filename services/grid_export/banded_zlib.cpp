#include "services/grid_export/banded_zlib.h"

#include <zlib.h>

#include <algorithm>
#include <initializer_list>
#include <stdexcept>

namespace voxlist::services {
namespace {

// Grids are large areas of one value: more effort saves little.
constexpr int kLevel = 1;

constexpr std::size_t kBandBytes = std::size_t{1} << 16;

// A stream's first two bytes for this level, and its last block, which is empty (RFC 1950, 1951).
constexpr std::initializer_list<std::uint8_t> kHeader = {0x78, 0x01}, kLastBlock = {0x03, 0x00};

}  // namespace

// A full flush ends on a whole byte, and what follows does not refer to what came before.
void BandedZlib::deflate(Band& band) {
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib cannot compress a grid");
  band.deflated.resize(deflateBound(&stream, band.bytes.size()) + 16);
  stream.next_in = band.bytes.data();
  stream.avail_in = static_cast<uInt>(band.bytes.size());
  stream.next_out = band.deflated.data();
  stream.avail_out = static_cast<uInt>(band.deflated.size());
  const int result = ::deflate(&stream, Z_FULL_FLUSH);
  band.deflated.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_OK || stream.avail_in != 0)
    throw std::runtime_error("zlib cannot compress a grid");
  band.adler = adler32(1, band.bytes.data(), static_cast<uInt>(band.bytes.size()));
}

std::vector<std::uint8_t> BandedZlib::compress(std::span<const std::uint8_t> bytes) {
  bands_.resize((bytes.size() + kBandBytes - 1) / kBandBytes);
  std::vector<std::uint8_t> stream = kHeader;
  uLong adler = 1;
  for (Band& band : bands_) {
    const auto part = bytes.first(std::min(kBandBytes, bytes.size()));
    bytes = bytes.subspan(part.size());
    if (!std::ranges::equal(part, band.bytes)) {
      band.bytes.assign(part.begin(), part.end());
      deflate(band);
    }
    stream.insert(stream.end(), band.deflated.begin(), band.deflated.end());
    adler = adler32_combine(adler, band.adler, static_cast<z_off_t>(part.size()));
  }
  stream.insert(stream.end(), kLastBlock);
  for (const int shift : {24, 16, 8, 0})
    stream.push_back(static_cast<std::uint8_t>(adler >> shift));
  return stream;
}

}  // namespace voxlist::services
