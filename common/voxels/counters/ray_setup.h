#pragma once
// As ray_kernel.h: for files that are compiled for one instruction set each.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "voxlist/voxels/counters/ray_job.h"

namespace voxlist {
namespace {

/// Ends of rays, each coordinate for itself; the rest is 0.
struct RayEnds {
  static constexpr std::size_t kMost = 64;

  RayEnds(const FixedRay* rays, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at[axis][i] = rays[i].from[axis];
        at[3 + axis][i] = rays[i].to[axis];
      }
    }
    for (std::size_t i = size; i < kMost; ++i)
      for (auto& coordinates : at) coordinates[i] = 0.0;
  }

  alignas(64) double at[6][kMost];
};

/// Slabs of as many rays as there are lanes, all in doubles: integers below 2^53. `v_time` and
/// `w_time` make times of crossings of what is left to a face: times the same positive number.
template <std::size_t kLanes>
struct SlabsOfLanes {
  alignas(64) double length[kLanes], inverse[kLanes], size[kLanes], u_first[kLanes];
  alignas(64) double v_step[kLanes], v_face[kLanes], v_first[kLanes], v_last[kLanes];
  alignas(64) double w_step[kLanes], w_face[kLanes], w_first[kLanes], w_last[kLanes];
  alignas(64) double v_time[kLanes], w_time[kLanes], u[kLanes];
};

/// Makes what slabs_of() makes, for several rays at once.
template <class Doubles, class Integers>
class RaySetup {
 public:
  static constexpr std::size_t kLanes = sizeof(Doubles) / sizeof(double);

  RaySetup(const RayEnds& ends, std::size_t first) {
    for (int i = 0; i < 3; ++i) {
      std::memcpy(&from_[i], &ends.at[i][first], sizeof from_[i]);
      std::memcpy(&to_[i], &ends.at[3 + i][first], sizeof to_[i]);
    }
  }

  void put(SlabsOfLanes<kLanes>& out) {
    choose_axes();
    const Integers turned = u_.to < u_.from;
    turn(u_, turned);
    turn(v_, turned);
    turn(w_, turned);
    const Doubles fine = Doubles{} + 1.0, coarse = Doubles{} + 1.0 / 32.0;
    scale_ = u_.to - u_.from < static_cast<double>(kFineLength) ? fine : coarse;
    const Cells u = cells(u_), v = cells(v_), w = cells(w_);
    length_ = whole(u_.to * scale_) - u.from;
    one_ = scale_ * kOne;
    to_face_ = (u.first + 1.0) * one_ - u.from;
    const Doubles v_step = whole(v_.to * scale_) - v.from, w_step = whole(w_.to * scale_) - w.from;
    store(out.length, length_);
    store(out.inverse, 1.0 / (length_ > 0.0 ? length_ : fine));
    store(out.size, u.last - u.first + 1.0);
    store(out.u, is_x_ ? Doubles{} : is_z_ ? fine + fine : fine);
    store(out.u_first, u.first);
    store(out.v_step, v_step);
    store(out.w_step, w_step);
    store(out.v_face, face(v, v_step));
    store(out.w_face, face(w, w_step));
    store(out.v_first, v.first);
    store(out.v_last, v.last);
    store(out.w_first, w.first);
    store(out.w_last, w.last);
    store(out.v_time, v_step < 0.0 ? -magnitude(w_step) : magnitude(w_step));
    store(out.w_time, w_step < 0.0 ? -magnitude(v_step) : magnitude(v_step));
  }

 private:
  static constexpr double kOne = std::int32_t{1} << kFractionBits;

  struct Ends {
    Doubles from, to;
  };

  // Cells of the ends, and where it starts.
  struct Cells {
    Doubles first, last, from;
  };

  // The next integer below a number of which only 16 bits stand behind the point.
  static Doubles whole(const Doubles& value) {
    constexpr double kRounding = 6755399441055744.0;  // as in ray_kernel.h
    return (value - (0.5 - 1.0 / 65536.0)) + kRounding - kRounding;
  }

  static Doubles magnitude(const Doubles& value) { return value < 0.0 ? -value : value; }

  static void turn(Ends& ends, const Integers& turned) {
    const Ends given = ends;
    ends.from = turned ? given.to : given.from;
    ends.to = turned ? given.from : given.to;
  }

  static void store(double* to, const Doubles& value) { std::memcpy(to, &value, sizeof value); }

  void choose_axes() {
    const Doubles x = magnitude(to_[0] - from_[0]), y = magnitude(to_[1] - from_[1]),
                  z = magnitude(to_[2] - from_[2]);
    is_x_ = (x >= y) & (x >= z);
    is_z_ = ~is_x_ & ~(y >= z);
    u_ = {is_x_ ? from_[0] : is_z_ ? from_[2] : from_[1], is_x_ ? to_[0] : is_z_ ? to_[2] : to_[1]};
    v_ = {is_x_ ? from_[1] : from_[0], is_x_ ? to_[1] : to_[0]};
    w_ = {is_z_ ? from_[1] : from_[2], is_z_ ? to_[1] : to_[2]};
  }

  Cells cells(const Ends& ends) const {
    return {whole(ends.from * (1.0 / kOne)), whole(ends.to * (1.0 / kOne)),
            whole(ends.from * scale_)};
  }

  Doubles face(const Cells& cells, const Doubles& step) const {
    const Doubles inside = cells.from - cells.first * one_;
    return cells.first * length_ + whole((inside * length_ + step * to_face_) / one_);
  }

  Doubles from_[3], to_[3];
  Integers is_x_, is_z_;
  Ends u_, v_, w_;
  Doubles scale_, one_, length_, to_face_;
};

}  // namespace
}  // namespace voxlist
