#include "voxlist/mapping/graph/sparse_inverse.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace voxlist::mapping {

using Factors = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>;

SparseInverse::SparseInverse(const Factors& factors)
    : below_(factors.matrixL().nestedExpression().triangularView<Eigen::StrictlyLower>()),
      diagonal_(factors.vectorD().cwiseInverse()),
      place_(factors.permutationP().indices()) {
  for (Eigen::Index column = below_.cols(); column-- > 0;) invert_column(column);
}

// With L the factor and Z the inverse: Z_rj = -sum over k of Z_rk L_kj, and
// Z_jj = 1 / D_j - sum over k of Z_jk L_kj, where k are the rows that column j of L has entries in.
void SparseInverse::invert_column(Eigen::Index column) {
  const int* const first = below_.outerIndexPtr();
  const int begin = first[column], end = first[column + 1];
  const int* const rows = below_.innerIndexPtr();
  double* const values = below_.valuePtr();
  const std::vector<double> factor(values + begin, values + end);
  std::vector<double> sums(factor.size(), 0.0);
  for (std::size_t b = 0; b < factor.size(); ++b) {
    const int other = rows[begin + static_cast<int>(b)];
    sums[b] += diagonal_(other) * factor[b];
    int at = first[other];
    for (std::size_t a = b + 1; a < factor.size(); ++a) {
      const int row = rows[begin + static_cast<int>(a)];
      while (rows[at] < row) ++at;
      sums[a] += values[at] * factor[b];
      sums[b] += values[at] * factor[a];
    }
  }
  for (std::size_t a = 0; a < factor.size(); ++a) {
    values[begin + static_cast<int>(a)] = -sums[a];
    diagonal_(column) += sums[a] * factor[a];
  }
}

double SparseInverse::operator()(Eigen::Index row, Eigen::Index column) const {
  int a = place_(row), b = place_(column);
  if (a == b) return diagonal_(a);
  if (a < b) std::swap(a, b);
  const int* const begin = below_.innerIndexPtr() + below_.outerIndexPtr()[b];
  const int* const end = below_.innerIndexPtr() + below_.outerIndexPtr()[b + 1];
  return below_.valuePtr()[std::lower_bound(begin, end, a) - below_.innerIndexPtr()];
}

}  // namespace voxlist::mapping
