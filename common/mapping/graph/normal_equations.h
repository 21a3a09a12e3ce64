#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <vector>

namespace voxlist::mapping {

/// The normal equations of poses of kDof coordinates each, of which the first pose stays where it
/// is. Sums go in the order of the edges that are added.
template <int kDof>
class NormalEquations {
 public:
  using Block = Eigen::Matrix<double, kDof, kDof>;
  using Part = Eigen::Matrix<double, kDof, 1>;

  /// `hold`: the information that holds each coordinate where no edge does.
  NormalEquations(std::size_t poses, double hold)
      : size_(first_of(poses)), gradient_(Eigen::VectorXd::Zero(size_)) {
    for (Eigen::Index i = 0; i < size_; ++i) triplets_.emplace_back(i, i, hold);
  }

  /// An edge that is missed by `miss`, which changes with the two poses by these slopes.
  void add(std::size_t from, const Block& slope_from, std::size_t to, const Block& slope_to,
           const Block& information, const Part& miss) {
    const Part pull = information * miss;
    add_pull(from, slope_from.transpose() * pull);
    add_pull(to, slope_to.transpose() * pull);
    add_block(from, from, slope_from.transpose() * information * slope_from);
    add_block(to, to, slope_to.transpose() * information * slope_to);
    if (from > to)
      add_block(from, to, slope_from.transpose() * information * slope_to);
    else
      add_block(to, from, slope_to.transpose() * information * slope_from);
  }

  /// Only the lower half is filled.
  Eigen::SparseMatrix<double> information() const {
    Eigen::SparseMatrix<double> information(size_, size_);
    information.setFromTriplets(triplets_.begin(), triplets_.end());
    return information;
  }

  const Eigen::VectorXd& gradient() const { return gradient_; }

  /// Where the coordinates of a pose begin, which is not the first one.
  static Eigen::Index first_of(std::size_t pose) {
    return kDof * (static_cast<Eigen::Index>(pose) - 1);
  }

 private:
  void add_pull(std::size_t pose, const Part& pull) {
    if (pose > 0) gradient_.template segment<kDof>(first_of(pose)) += pull;
  }

  void add_block(std::size_t row, std::size_t column, const Block& block) {
    if (row == 0 || column == 0) return;
    for (int i = 0; i < kDof; ++i)
      for (int j = 0; j < kDof; ++j)
        if (row != column || i >= j)
          triplets_.emplace_back(first_of(row) + i, first_of(column) + j, block(i, j));
  }

  Eigen::Index size_;
  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double>> triplets_;
};

}  // namespace voxlist::mapping
