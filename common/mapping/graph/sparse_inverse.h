#pragma once

#include <Eigen/SparseCholesky>

namespace voxlist::mapping {

/// The inverse of a sparse symmetric matrix, where the matrix itself has entries, without the rest
/// of it, which is dense (Takahashi, Fagan and Chen 1973: from the last column of its factor to the
/// first).
class SparseInverse {
 public:
  /// The factors of the matrix; they must have been a success.
  explicit SparseInverse(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& factors);

  /// Precondition: the matrix has an entry there, be it 0.
  double operator()(Eigen::Index row, Eigen::Index column) const;

 private:
  void invert_column(Eigen::Index column);

  // The factor below its diagonal; column by column, the inverse takes its place.
  Eigen::SparseMatrix<double> below_;
  Eigen::VectorXd diagonal_;
  // Where a row of the matrix is among those of its factor.
  Eigen::VectorXi place_;
};

}  // namespace voxlist::mapping
