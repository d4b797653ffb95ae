#include "harness/references/heavy_top_wide.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace liebench {

namespace {

void require_finite(double x, const char* what) {
  if (!std::isfinite(x)) throw std::invalid_argument(std::string("heavy top: ") + what + " is not finite");
}

void validate(const HeavyTopParameters& p) {
  require_finite(p.mass, "mass");
  for (std::size_t i = 0; i < 3; ++i) {
    require_finite(p.center_of_mass[i], "center_of_mass");
    require_finite(p.gravity[i], "gravity");
    require_finite(p.angular_velocity[i], "angular_velocity");
    for (std::size_t j = 0; j < 3; ++j) {
      require_finite(p.inertia[i][j], "inertia");
      if (p.inertia[i][j] != p.inertia[j][i])
        throw std::invalid_argument("heavy top: inertia is not symmetric");
    }
  }
  double length = 0;
  for (const double x : p.orientation) {
    require_finite(x, "orientation");
    length = std::max(length, std::abs(x));
  }
  if (length == 0) throw std::invalid_argument("heavy top: orientation is the zero quaternion");
}

// By the adjugate; Sylvester's criterion on the way.
WideMatrix inverse_of_spd(const WideMatrix& A) {
  const Wide minor = A[0][0] * A[1][1] - A[0][1] * A[1][0];
  const WideVector c0 = cross(A[1], A[2]);
  const Wide determinant = dot(A[0], c0);
  if (!(A[0][0] > 0) || !(minor > 0) || !(determinant > 0)) {
    throw std::invalid_argument("heavy top: the inertia about the tip is not positive definite");
  }
  const WideVector c1 = cross(A[2], A[0]);
  const WideVector c2 = cross(A[0], A[1]);
  WideMatrix inverse;
  for (std::size_t i = 0; i < 3; ++i) {
    inverse[i] = {c0[i] / determinant, c1[i] / determinant, c2[i] / determinant};
  }
  return inverse;
}

}  // namespace

HeavyTopWideData::HeavyTopWideData(const HeavyTopParameters& parameters) {
  validate(parameters);
  inertia = inertia_about_tip<Wide>(parameters);
  inertia_inverse = inverse_of_spd(inertia);
  const Wide mass = decimal<Wide>(parameters.mass);
  first_moment = decimal<Wide>(parameters.center_of_mass);
  for (Wide& x : first_moment) x *= mass;
  gravity = decimal<Wide>(parameters.gravity);
  omega = decimal<Wide>(parameters.angular_velocity);
  orientation = initial_orientation<Wide>(parameters);
}

double HeavyTopWideData::pendulum_frequency() const {
  double stiffest = 0;
  for (const WideVector& row : inertia_inverse) stiffest = std::max(stiffest, norm(row));
  return std::sqrt(norm(gravity) * norm(first_moment) * stiffest);
}

WideVector cross(const WideVector& a, const WideVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Wide dot(const WideVector& a, const WideVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double norm(const WideVector& v) {
  return sqrt(dot(v, v)).convert_to<double>();
}

WideVector multiply(const WideMatrix& A, const WideVector& x) {
  return {dot(A[0], x), dot(A[1], x), dot(A[2], x)};
}

WideMatrix multiply(const WideMatrix& A, const WideMatrix& B) {
  const WideMatrix columns = transposed(B);
  return {multiply(columns, A[0]), multiply(columns, A[1]), multiply(columns, A[2])};
}

WideMatrix transposed(const WideMatrix& A) {
  return {WideVector{A[0][0], A[1][0], A[2][0]}, WideVector{A[0][1], A[1][1], A[2][1]},
          WideVector{A[0][2], A[1][2], A[2][2]}};
}

WideMatrix rotation_matrix(const std::array<Wide, 4>& p) {
  const auto& [w, x, y, z] = p;
  return {WideVector{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
          WideVector{2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
          WideVector{2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
}

Extended to_extended(const Wide& x) {
  const double high = x.convert_to<double>();
  const double low = Wide(x - high).convert_to<double>();
  return Extended(high) + low;
}

Wide to_wide(const Extended& x) {
  return Wide(x.x[0]) + x.x[1];
}

}  // namespace liebench
