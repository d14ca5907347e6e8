#include "proofmass/core/random.hpp"

#include <cmath>
#include <numbers>

namespace proofmass {
namespace {

/// Source: S. Vigna, splitmix64.c (2015); after G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014.
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

std::uint64_t stream(std::uint64_t seed, std::string_view purpose, std::size_t index) {
  std::uint64_t state = mixed(seed);
  for (const char c : purpose) state = mixed(state ^ static_cast<unsigned char>(c));
  return mixed(state ^ index);
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view purpose, std::size_t index)
    : engine_(stream(seed, purpose, index)) {}

double Random::unit() {
  return static_cast<double>(engine_() >> 11U) * 0x1p-53;
}

double Random::uniform() {
  return 2.0 * unit() - 1.0;
}

double Random::phase() {
  return 2.0 * std::numbers::pi * unit();
}

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - unit()));
  const double angle = phase();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace proofmass
