#pragma once
// Marking rays several slabs at once, for files that are compiled for one instruction set each. It
// calls nothing from elsewhere: a shared inline function that one of them compiled could end up in
// the portable code. All numbers in doubles are integers below 2^53, or are rounded to one with a
// margin that no rounding reaches, so every width gives the same cells.

#include <cstdint>
#include <cstring>
#include <utility>

#include "voxlist/voxels/counters/mark_buffer.h"
#include "voxlist/voxels/counters/ray_setup.h"

namespace voxlist {
namespace {

/// One axis across a ray: what is the same for all slabs, and the state of the lanes' slabs.
template <class Doubles, class Integers>
struct CrossAxis {
  int number, block_shift;
  double step, to_nearest, last;
  Doubles face;         // numerators of the places where the lanes' slabs end
  Doubles cell_before;  // of the slabs of before
  Integers key_before;
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
  static constexpr std::int64_t kCellMask = (std::int64_t{1} << kBoxBits) - 1;
  static constexpr Integers kNoWord = Integers{} - 1;
  static constexpr double kLaneNumbers[8] = {0, 1, 2, 3, 4, 5, 6, 7};

 public:
  explicit RayMarker(const RayJob& job) : job_(job), marks_(*job.cells) {
    std::memcpy(&lane_, kLaneNumbers, sizeof lane_);
    for (std::size_t i = 0; i < kLanes; ++i) lane_number_[i] = static_cast<std::int64_t>(i);
  }

  void mark_all() {
    for (std::size_t i = 0; i < job_.size; i += RayEnds::kMost) {
      const std::size_t size = job_.size - i < RayEnds::kMost ? job_.size - i : RayEnds::kMost;
      const RayEnds ends(job_.rays + i, size);
      for (std::size_t k = 0; k < size; k += kLanes) {
        SlabsOfLanes<kLanes> slabs;
        RaySetup<Doubles, Integers>(ends, k).put(slabs);
        for (std::size_t lane = 0; lane < kLanes && k + lane < size; ++lane) mark_ray(slabs, lane);
      }
    }
  }

 private:
  using Axis = CrossAxis<Doubles, Integers>;

  void mark_ray(const SlabsOfLanes<kLanes>& s, std::size_t i) {
    length_ = s.length[i];
    inverse_ = s.inverse[i];
    v_time_ = s.v_time[i];
    w_time_ = s.w_time[i];
    const int u_axis = static_cast<int>(s.u[i]);
    Axis v = axis(u_axis == 0 ? 1 : 0, s.v_step[i], s.v_face[i], s.v_first[i], s.v_last[i]);
    Axis w = axis(u_axis == 2 ? 1 : 2, s.w_step[i], s.w_face[i], s.w_first[i], s.w_last[i]);
    Integers u = lane_number_ + static_cast<std::int64_t>(s.u_first[i]);
    Integers u_key = key_part(u, u_axis, job_.block_shift[u_axis]);
    for (auto left = static_cast<std::int32_t>(s.size[i]); left > 0;
         left -= static_cast<std::int32_t>(kLanes)) {
      mark_slabs(u_key, v, w, left);
      if constexpr (kLanes == 8) {  // a block farther
        u_key += std::int64_t{1} << job_.block_shift[u_axis];
      } else {
        u += static_cast<std::int64_t>(kLanes);
        u_key = key_part(u, u_axis, job_.block_shift[u_axis]);
      }
    }
  }

  Axis axis(int number, double step, double face, double first, double last) const {
    Axis a;
    a.number = number;
    a.block_shift = job_.block_shift[number];
    a.step = step;
    a.to_nearest = 0.5 - 0.5 * length_;
    a.last = last;
    a.face = lane_ * step + face;
    a.cell_before = Doubles{} + first;
    a.key_before = Integers{} + key_part(static_cast<std::int64_t>(first), number, a.block_shift);
    return a;
  }

  struct Crossing {
    Integers key_in, key_out;
    Doubles time;
  };

  // Where each slab is entered and left along an axis, and when the face between is crossed.
  Crossing cross(Axis& a, const Integers& is_last) const {
    const Doubles rounded = (a.face + a.to_nearest) * inverse_ + kRounding;
    const Doubles out = is_last ? Doubles{} + a.last : rounded - kRounding;
    const Doubles in = part<kLanes - 1>(a.cell_before, out);
    const Doubles in_lowest_bits = out + kRounding;
    Integers cell;
    std::memcpy(&cell, &in_lowest_bits, sizeof cell);
    Crossing c;
    c.key_out = key_part(cell & kCellMask, a.number, a.block_shift);
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
    const Integers is_there = lane_number_ < std::int64_t{left};
    const Integers in_word = is_there ? in >> 6 : kNoWord;
    const Integers corner_word = corner >> 6, out_word = out >> 6;
    const Integers corner_bit = one << (corner & 63), out_bit = one << (out & 63);
    const Integers in_bits = one << (in & 63) | (corner_bit & (corner_word == in_word)) |
                             (out_bit & (out_word == in_word));
    put_runs(in_word, in_bits);
    marks_.add(is_there & (out_word != in_word), out_word,
               out_bit | (corner_bit & (corner_word == out_word)));
    const Integers is_apart = is_there & (corner_word != in_word) & (corner_word != out_word);
    if (MarkBuffer::has_any(is_apart)) marks_.add(is_apart, corner_word, corner_bit);
  }

  // Lanes side by side in one word are four at most. The last of them puts the bits of all: to mark
  // one word again and again would wait each time for the time before.
  void put_runs(const Integers& word, Integers bits) {
    const Integers none{};
    bits |= part<kLanes - 1>(kNoWord, word) == word ? part<kLanes - 1>(none, bits) : none;
    bits |= part<kLanes - 2>(kNoWord, word) == word ? part<kLanes - 2>(none, bits) : none;
    marks_.add(part<1>(word, kNoWord) != word, word, bits);
  }

  const RayJob& job_;
  MarkBuffer marks_;
  Doubles lane_;
  Integers lane_number_;
  double length_ = 0.0, inverse_ = 0.0;
  double v_time_ = 0.0, w_time_ = 0.0;
};

template <class Doubles, class Integers>
void mark_rays_wide(const RayJob& job) {
  RayMarker<Doubles, Integers>(job).mark_all();
}

}  // namespace
}  // namespace voxlist
