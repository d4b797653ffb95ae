#include "harness/stability/scaling.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "integrators/bdf_coefficients.h"
#include "integrators/step_equation.h"
#include "problems/heavy_top.h"

namespace liebench {

namespace {

using Top = HeavyTopR3xSO3<double>;
using Equation = StepEquation<Top>;
constexpr int m = Equation::m, l = Equation::l, n = Equation::n;
using NewtonMatrix = Eigen::Matrix<double, n, n>;
using Unknowns = Equation::Unknowns;

// At the initial values, with multipliers of their size there.
NewtonMatrix scaled_matrix(double h) {
  const Top top{HeavyTopParameters{}};
  Equation::Point p;
  p.q = top.initial_configuration();
  p.values.velocity = top.initial_velocity();
  p.step = h * p.values.velocity;
  p.values.scaled_acceleration.setZero();
  Unknowns z = Unknowns::Zero();
  z.tail<l>() = h * Eigen::Vector3d(0.0, -319.5, -317.3);
  const double gamma = bdf_coefficients<double>(3).gamma[0];
  NewtonMatrix J;
  Equation::jacobian(top, 0.0, h, top.initial_configuration(), p, z,
                     ClosureDerivatives<double>{gamma, gamma * gamma}, J);
  return J;
}

double condition(const NewtonMatrix& J) {
  // In 80 bits: singular values of a matrix whose condition is beyond 1 / eps.
  using Wide = Eigen::Matrix<long double, n, n>;
  const auto values = Eigen::JacobiSVD<Wide>(J.cast<long double>()).singularValues();
  return double(values(0) / values(n - 1));
}

// |lambda - exact| / |exact| of J x = J exact, the right side from 80 bits.
double multiplier_error(const NewtonMatrix& J, const Unknowns& exact) {
  const Unknowns right = (J.cast<long double>() * exact.cast<long double>()).cast<double>();
  const Unknowns x = J.fullPivLu().solve(right);
  return (x - exact).tail<l>().norm() / exact.tail<l>().norm();
}

}  // namespace

Table scaling_table() {
  Table table(
      "", {{.header = "h", .unit = "s", .kind = ColumnKind::number, .alignment = Alignment::right},
           {.header = "condition, scaled", .kind = ColumnKind::number, .alignment = Alignment::right},
           {.header = "as it stands", .kind = ColumnKind::number, .alignment = Alignment::right},
           {.header = "rank in double, scaled", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "as it stands", .kind = ColumnKind::integer, .alignment = Alignment::right},
           {.header = "error of lambda, scaled", .kind = ColumnKind::number, .alignment = Alignment::right},
           {.header = "as it stands", .kind = ColumnKind::number, .alignment = Alignment::right}});
  for (const double h : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const NewtonMatrix scaled = scaled_matrix(h);
    // Rows (h r, Phi / h) to (r, Phi), columns (Dq, h lambda) to (h Dq, lambda).
    Unknowns by = Unknowns::Constant(h);
    by.head<m>().setConstant(1.0 / h);
    const NewtonMatrix plain = by.asDiagonal() * scaled * by.asDiagonal();
    Unknowns exact = Unknowns::Constant(1e-3);
    exact.tail<l>() = h * Eigen::Vector3d(10.0, -319.5, -317.3);
    table.add_row({h, condition(scaled), condition(plain), std::int64_t(scaled.fullPivLu().rank()),
                   std::int64_t(plain.fullPivLu().rank()), multiplier_error(scaled, exact),
                   multiplier_error(plain, exact.cwiseQuotient(by))});
  }
  return table;
}

}  // namespace liebench
