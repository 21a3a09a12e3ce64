#include "voxlist/voxels/counters/mark_rays.h"

#include <algorithm>

namespace voxlist {

std::size_t take_points_avx2(PointJob& job);
std::size_t take_points_avx512(PointJob& job);
std::size_t mark_ends_avx2(const EndJob& job);
std::size_t mark_ends_avx512(const EndJob& job);
void mark_rays_avx2(const RayJob& job);
void mark_rays_avx512(const RayJob& job);

namespace {

std::uint64_t key_of_cell(const std::int32_t cell[3], const int block_shift[3]) {
  const std::int64_t key = key_part(std::int64_t{cell[0]}, 0, block_shift[0]) |
                           key_part(std::int64_t{cell[1]}, 1, block_shift[1]) |
                           key_part(std::int64_t{cell[2]}, 2, block_shift[2]);
  return static_cast<std::uint64_t>(key);
}

// Whole cells and what is left of a fraction, which grows by a step of up to one cell.
class Place {
 public:
  Place(std::int64_t numerator, std::int64_t step, std::int64_t length)
      : whole_(numerator / length), rest_(numerator % length), step_(step), length_(length) {
    if (rest_ < 0) carry(-1);
  }

  std::int32_t cell() const { return static_cast<std::int32_t>(whole_); }

  void go() {
    rest_ += step_;
    if (rest_ < 0) carry(-1);
    if (rest_ >= length_) carry(1);
  }

  // From the slab's beginning, of which this is the end, to a face: in length_ of a cell.
  std::int64_t way_to(std::int64_t face) const {
    return (face - whole_) * length_ - (rest_ - step_);
  }

 private:
  void carry(std::int64_t cells) {
    whole_ += cells;
    rest_ -= cells * length_;
  }

  std::int64_t whole_, rest_, step_, length_;
};

// Gathers what falls into one word.
class WordSink {
 public:
  explicit WordSink(const RayJob& job) : job_(job) {}
  ~WordSink() { put(); }
  WordSink(const WordSink&) = delete;
  WordSink& operator=(const WordSink&) = delete;

  void mark(const std::int32_t cell[3]) {
    const std::uint64_t key = key_of_cell(cell, job_.block_shift), word = key >> 6;
    if (word != word_) put();
    word_ = word;
    bits_ |= std::uint64_t{1} << (key & 63);
  }

 private:
  void put() {
    if (bits_ != 0) word_at(*job_.cells, word_) |= bits_;
    bits_ = 0;
  }

  const RayJob& job_;
  std::uint64_t word_ = 0, bits_ = 0;
};

bool crosses_v_first(const Slabs& s, std::int64_t v_way, std::int64_t w_way) {
  // Below 2^26 and 2^27 each.
  const std::int64_t v = v_way * (s.w_step < 0 ? -s.w_step : s.w_step);
  const std::int64_t w = w_way * (s.v_step < 0 ? -s.v_step : s.v_step);
  return (s.v_step < 0 ? -v : v) < (s.w_step < 0 ? -w : w);
}

void mark_ray(const FixedRay& ray, const RayJob& job) {
  const Slabs s = slabs_of(ray);
  WordSink sink(job);
  std::int32_t cell[3] = {s.first[0], s.first[1], s.first[2]};
  sink.mark(cell);
  if (s.length == 0) return;
  Place v(s.v_face, s.v_step, s.length), w(s.w_face, s.w_step, s.length);
  for (std::int32_t i = 1; i <= s.size; ++i) {
    const std::int32_t v_out = i < s.size ? v.cell() : s.last[s.v];
    const std::int32_t w_out = i < s.size ? w.cell() : s.last[s.w];
    if (v_out != cell[s.v] && w_out != cell[s.w]) {
      const bool v_first = crosses_v_first(s, v.way_to(std::max(v_out, cell[s.v])),
                                           w.way_to(std::max(w_out, cell[s.w])));
      cell[v_first ? s.v : s.w] = v_first ? v_out : w_out;
      sink.mark(cell);
    }
    cell[s.v] = v_out;
    cell[s.w] = w_out;
    sink.mark(cell);
    if (i == s.size) break;
    ++cell[s.u];
    sink.mark(cell);
    v.go();
    w.go();
  }
}

}  // namespace

std::size_t take_points(PointJob& job, Instructions instructions) {
  if (instructions == Instructions::kAvx512) return take_points_avx512(job);
  return instructions == Instructions::kAvx2 ? take_points_avx2(job) : take_points(job);
}

std::size_t mark_ends(const EndJob& job, Instructions instructions) {
  if (instructions == Instructions::kAvx512) return mark_ends_avx512(job);
  return instructions == Instructions::kAvx2 ? mark_ends_avx2(job) : mark_ends(job);
}

void mark_rays(const RayJob& job, Instructions instructions) {
  switch (instructions) {
    case Instructions::kPortable:
      for (std::size_t i = 0; i < job.size; ++i) mark_ray(job.rays[i], job);
      break;
    case Instructions::kAvx2:
      mark_rays_avx2(job);
      break;
    case Instructions::kAvx512:
      mark_rays_avx512(job);
      break;
  }
}

}  // namespace voxlist
