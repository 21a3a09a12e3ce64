#pragma once
// Marking rays several slabs at once, for files that are compiled for one instruction set each. It
// calls nothing from elsewhere: a shared inline function that one of them compiled could end up in
// the portable code. All numbers in doubles are integers below 2^53, or are rounded to one with a
// margin that no rounding reaches, so every width gives the same cells.

#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>

#include "voxlist/voxels/counters/ray_job.h"

namespace voxlist {
namespace {

/// One axis across the ray: what is the same for all slabs, and the counts of the lanes' slabs.
template <class Doubles, class Integers, std::size_t kLanes>
struct CrossAxis {
  int key_shift, block_shift;
  double step, to_nearest;
  Doubles face;         // numerators of the places where the lanes' slabs end
  Integers key_before;  // of the slabs of before
  Doubles cell_before;
  std::int64_t last;  // cell
};

template <std::size_t kFirst, class Vector, std::size_t... kIndices>
inline Vector part(const Vector& low, const Vector& high, std::index_sequence<kIndices...>) {
  return __builtin_shufflevector(low, high, (kFirst + kIndices)...);
}

/// The lanes from kFirst on of two vectors in a row.
template <std::size_t kFirst, class Vector>
inline Vector part(const Vector& low, const Vector& high) {
  return part<kFirst>(low, high, std::make_index_sequence<sizeof(Vector) / 8>());
}

template <class Doubles, class Integers>
class RayMarker {
  static constexpr std::size_t kLanes = sizeof(Doubles) / sizeof(double);
  // 1.5 times 2^52: adding it rounds to an integer, which then stands in the lowest bits.
  static constexpr double kRounding = 6755399441055744.0;
  static constexpr std::int64_t kRoundingBits = std::int64_t{0x4338} << 48;
  static constexpr Integers kNoWord = Integers{} - 1;
  static constexpr double kLaneNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};

 public:
  explicit RayMarker(const RayJob& job) : job_(job) {
    std::memcpy(&lane_, kLaneNumbers, sizeof lane_);
    for (std::size_t i = 0; i < kLanes; ++i) lane_number_[i] = static_cast<std::int64_t>(i);
    spare_ = lane_number_ + static_cast<std::int64_t>(job.spare_word);
  }

  void mark(const FixedRay& ray) {
    const Slabs slabs = slabs_of(ray);
    if (slabs.length == 0) return mark_one(slabs);
    const auto length = static_cast<double>(slabs.length);
    inverse_ = 1.0 / length;
    length_ = length;
    Axis v = axis(slabs, slabs.v, slabs.v_face, slabs.v_step);
    Axis w = axis(slabs, slabs.w, slabs.w_face, slabs.w_step);
    // Times of crossings, times the same positive number.
    v_time_ = slabs.v_step < 0 ? -magnitude_of(w.step) : magnitude_of(w.step);
    w_time_ = slabs.w_step < 0 ? -magnitude_of(v.step) : magnitude_of(v.step);
    Integers u = lane_number_ + std::int64_t{slabs.first[slabs.u]};
    for (std::int32_t left = slabs.size; left > 0; left -= static_cast<std::int32_t>(kLanes)) {
      mark_slabs(key_part(u, slabs.u, job_.block_shift[slabs.u]), v, w, left);
      u += static_cast<std::int64_t>(kLanes);
    }
  }

 private:
  using Axis = CrossAxis<Doubles, Integers, kLanes>;

  static double magnitude_of(double value) { return value < 0 ? -value : value; }

  void mark_one(const Slabs& slabs) {
    std::int64_t key = 0;
    for (int i = 0; i < 3; ++i)
      key |= key_part(std::int64_t{slabs.first[i]}, i, job_.block_shift[i]);
    word_at(*job_.cells, static_cast<std::uint64_t>(key) >> 6) |= std::uint64_t{1} << (key & 63);
  }

  Axis axis(const Slabs& slabs, int number, std::int64_t face, std::int64_t step) const {
    Axis a;
    a.key_shift = number;
    a.block_shift = job_.block_shift[number];
    a.step = static_cast<double>(step);
    a.to_nearest = 0.5 - 0.5 * length_;
    a.face = lane_ * a.step + static_cast<double>(face);
    a.cell_before = Doubles{} + static_cast<double>(slabs.first[number]);
    a.key_before = Integers{} + key_part(std::int64_t{slabs.first[number]}, number, a.block_shift);
    a.last = slabs.last[number];
    return a;
  }

  struct Crossing {
    Integers key_in, key_out;
    Doubles time;
  };

  // Where each slab is entered and left along an axis, and when the face between is crossed.
  Crossing cross(Axis& a, const Integers& is_last) const {
    const Doubles rounded = (a.face + a.to_nearest) * inverse_ + kRounding;
    Integers cell;
    std::memcpy(&cell, &rounded, sizeof cell);
    cell = is_last ? Integers{} + a.last : cell - kRoundingBits;
    const Doubles out = is_last ? Doubles{} + static_cast<double>(a.last) : rounded - kRounding;
    const Doubles in = part<kLanes - 1>(a.cell_before, out);
    Crossing c;
    c.key_out = key_part(cell, a.key_shift, a.block_shift);
    c.key_in = part<kLanes - 1>(a.key_before, c.key_out);
    c.time = (in > out ? in : out) * length_ - (a.face - a.step);
    a.cell_before = out;
    a.key_before = c.key_out;
    a.face += a.step * static_cast<double>(kLanes);
    return c;
  }

  void mark_slabs(const Integers& u_key, Axis& v, Axis& w, std::int32_t left) {
    const Integers is_last = lane_number_ == std::int64_t{left - 1};
    const Crossing a = cross(v, is_last), b = cross(w, is_last);
    const Integers v_first = a.time * v_time_ < b.time * w_time_;
    const Integers corner = u_key + (v_first ? a.key_out + b.key_in : a.key_in + b.key_out);
    put(u_key + a.key_in + b.key_in, corner, u_key + a.key_out + b.key_out, left);
  }

  // Marks the cell that each slab is entered in, the one that it is left from, and one between.
  void put(const Integers& in, const Integers& corner, const Integers& out, std::int32_t left) {
    const Integers one = Integers{} + 1;
    const Integers in_word = lane_number_ < std::int64_t{left} ? in >> 6 : kNoWord;
    const Integers corner_word = corner >> 6, out_word = out >> 6;
    const Integers corner_bit = one << (corner & 63), out_bit = one << (out & 63);
    const Integers in_bits = one << (in & 63) | (corner_bit & (corner_word == in_word)) |
                             (out_bit & (out_word == in_word));
    const Integers out_bits = out_bit | (corner_bit & (corner_word == out_word));
    const auto lanes = static_cast<std::size_t>(left) < kLanes ? static_cast<std::size_t>(left) : kLanes;
    put_runs(in_word, in_bits, lanes);
    put_words(out_word == in_word ? spare_ : out_word, out_bits, lanes);
    put_apart(corner, (corner_word != in_word) & (corner_word != out_word), lanes);
  }

  // Lanes side by side in one word are four at most. The last of them puts the bits of all: to mark
  // one word again and again would wait each time for the time before.
  void put_runs(const Integers& word, Integers bits, std::size_t lanes) {
    const Integers none{};
    bits |= part<kLanes - 1>(kNoWord, word) == word ? part<kLanes - 1>(none, bits) : none;
    bits |= part<kLanes - 2>(kNoWord, word) == word ? part<kLanes - 2>(none, bits) : none;
    put_words(part<1>(word, kNoWord) == word ? spare_ : word, bits, lanes);
  }

  void put_words(const Integers& word, const Integers& bits, std::size_t lanes) {
    alignas(64) std::uint64_t words[kLanes], marks[kLanes];
    std::memcpy(words, &word, sizeof word);
    std::memcpy(marks, &bits, sizeof bits);
    for (std::size_t i = 0; i < lanes; ++i) word_at(*job_.cells, words[i]) |= marks[i];
  }

  // Rare: the cell between lies in a word of its own.
  void put_apart(const Integers& corner, const Integers& is_apart, std::size_t lanes) {
    alignas(64) std::int64_t apart[kLanes];
    std::memcpy(apart, &is_apart, sizeof is_apart);
    std::int64_t any = 0;
    for (std::size_t i = 0; i < kLanes; ++i) any |= apart[i];
    if (any == 0) return;
    for (std::size_t i = 0; i < lanes; ++i) {
      const auto key = static_cast<std::uint64_t>(corner[i]);
      if (apart[i] != 0) word_at(*job_.cells, key >> 6) |= std::uint64_t{1} << (key & 63);
    }
  }

  const RayJob& job_;
  Doubles lane_;
  Integers lane_number_, spare_;
  double length_ = 0.0, inverse_ = 0.0;
  double v_time_ = 0.0, w_time_ = 0.0;
};

template <class Doubles, class Integers>
void mark_rays_wide(const RayJob& job) {
  RayMarker<Doubles, Integers> marker(job);
  for (std::size_t i = 0; i < job.size; ++i) marker.mark(job.rays[i]);
}

}  // namespace
}  // namespace voxlist
