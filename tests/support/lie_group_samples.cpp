#include "tests/support/lie_group_samples.h"

#include <concepts>

namespace liebench {

template <class T>
double GroupSamples<T>::eps() {
  return to_double(Eigen::NumTraits<T>::epsilon());
}

template <class T>
T GroupSamples<T>::pi() {
  if constexpr (std::same_as<T, Extended>)
    return dd_real::_pi;
  else
    return T(3.14159265358979323846);
}

template <class T>
double GroupSamples<T>::length_of(const Eigen::MatrixXd& v) {
  const double largest = v.size() > 0 ? v.lpNorm<Eigen::Infinity>() : 0.0;
  return largest > 0.0 ? largest * (v / largest).norm() : largest;
}

template <class T>
std::vector<double> GroupSamples<T>::angles() {
  return {1e-9, 1e-5, 1e-2, 0.1, 0.3, 0.4999, 0.5001, 1.0, 1.5, 1.9999, 2.0001, 2.5, 3.0, 3.1};
}

template <class T>
typename GroupSamples<T>::Matrix GroupSamples<T>::unit_matrix(Eigen::Index size) {
  return Matrix::Identity(size, size);
}

template <class T>
typename GroupSamples<T>::Vector GroupSamples<T>::representation(const Vector& q, const Vector& near) const {
  Vector next = q;
  for (const Vector& p : group_.representations(q))
    if (distance(p, near) < distance(next, near)) next = p;
  return next;
}

template <class T>
std::vector<typename GroupSamples<T>::Vector> GroupSamples<T>::tangents(const T& angle) const {
  std::vector<Vector> all;
  for (const Vector& d : group_.directions()) {
    const T turn = group_.rotation_angle(d);
    const T unit = turn > 0.0 ? turn : T(d.norm());
    all.push_back(d * T(angle / unit));
  }
  return all;
}

template <class T>
std::vector<typename GroupSamples<T>::Vector> GroupSamples<T>::elements() const {
  std::vector<Vector> all{group_.identity()};
  for (const double angle : {0.4, 1.7, 2.9}) {
    Vector q = group_.identity();
    for (const Vector& v : tangents(T(angle))) {
      q = group_.compose(q, group_.exp(v));
      all.push_back(q);
    }
  }
  return all;
}

template <class T>
typename GroupSamples<T>::Vector GroupSamples<T>::exponential_of_ad(const Vector& v, const Vector& w) const {
  Vector sum = w, term = w;
  for (int k = 1; k <= 60; ++k) {
    term = group_.commutator(v, term) / T(double(k));
    sum += term;
  }
  return sum;
}

template <class T>
typename GroupSamples<T>::Matrix GroupSamples<T>::tangent_series(const Vector& v) const {
  const Matrix minus_ad = -group_.ad(v);
  Matrix sum = unit_matrix(v.size()), term = sum;
  for (int k = 1; k <= 60; ++k) {
    term = Matrix(term * minus_ad) / T(double(k + 1));
    sum += term;
  }
  return sum;
}

template class GroupSamples<double>;
template class GroupSamples<Extended>;

}  // namespace liebench
