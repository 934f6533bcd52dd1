#pragma once

#include <cmath>
#include <cstddef>

namespace fw {

/// A vector in ℝ³ over any scalar of the project (double, Float128, std::complex<double>).
/// `dot` is bilinear (no conjugation), which is what differentiation by a complex step needs; Eigen's `dot`
/// and `norm` conjugate.
template <class Scalar>
struct Vec3 {
  Scalar x{}, y{}, z{};

  Vec3& operator+=(const Vec3& other) {
    x += other.x;
    y += other.y;
    z += other.z;
    return *this;
  }
  Vec3& operator-=(const Vec3& other) {
    x -= other.x;
    y -= other.y;
    z -= other.z;
    return *this;
  }
  Vec3& operator*=(const Scalar& factor) {
    x *= factor;
    y *= factor;
    z *= factor;
    return *this;
  }

  friend Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(const Scalar& factor, Vec3 a) { return a *= factor; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// aᵀb, without conjugation.
template <class Scalar>
Scalar dot(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// a × b.
template <class Scalar>
Vec3<Scalar> cross(const Vec3<Scalar>& a, const Vec3<Scalar>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// √(aᵀa), analytic in the components away from zero.
template <class Scalar>
Scalar norm(const Vec3<Scalar>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

/// The vector at index `i` of an array that stores xyz after xyz.
template <class Scalar>
Vec3<Scalar> load3(const Scalar* values, std::ptrdiff_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// Writes `a` at index `i` of an array that stores xyz after xyz.
template <class Scalar>
void store3(Scalar* values, std::ptrdiff_t i, const Vec3<Scalar>& a) {
  values[3 * i] = a.x;
  values[3 * i + 1] = a.y;
  values[3 * i + 2] = a.z;
}

/// Adds `a` to index `i` of an array that stores xyz after xyz.
template <class Scalar>
void add3(Scalar* values, std::ptrdiff_t i, const Vec3<Scalar>& a) {
  values[3 * i] += a.x;
  values[3 * i + 1] += a.y;
  values[3 * i + 2] += a.z;
}

}  // namespace fw
