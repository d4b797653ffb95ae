#pragma once

#include <Eigen/Core>

// Eigen's factorizations as witnesses, for matrices of any size: each is some sixty types to compile, and here they are compiled once.

namespace liebench {

// A x = b, by LU with full pivoting.
Eigen::VectorXd dense_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
// |A| |A^-1| in the norm of Frobenius.
double dense_condition(const Eigen::MatrixXd& A);
// The largest first.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);
// U of A = U P, orthogonal and positive definite.
Eigen::MatrixXd polar_factor(const Eigen::MatrixXd& A);
bool is_positive_definite(const Eigen::MatrixXd& A);
// Of a symmetric matrix.
double smallest_eigenvalue(const Eigen::MatrixXd& A);

}  // namespace liebench
