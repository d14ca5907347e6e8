#include "proofmass/acquire/iio/mount_matrix.hpp"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <fmt/format.h>

namespace proofmass::acquire {
namespace {

constexpr MountMatrix identity{1, 0, 0, 0, 1, 0, 0, 0, 1};

std::optional<MountMatrix> nine_numbers(std::string_view text) {
  MountMatrix matrix{};
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    const std::size_t begin = text.find_first_not_of(" \t\n");
    if (begin == std::string_view::npos) return std::nullopt;
    text.remove_prefix(begin);
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), matrix[k]);
    if (problem != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const char after = k == 8 ? '\0' : k % 3 == 2 ? ';' : ',';
    if (after == '\0') break;
    if (!text.starts_with(after)) return std::nullopt;
    text.remove_prefix(1);
  }
  if (text.find_first_not_of(" \t\n") != std::string_view::npos) return std::nullopt;
  return matrix;
}

// Device trees contain entries such as 0.7071.
bool is_orthonormal(const MountMatrix& m) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j) {
      const double dot =
          m[3 * i] * m[3 * j] + m[3 * i + 1] * m[3 * j + 1] + m[3 * i + 2] * m[3 * j + 2];
      if (!(std::abs(dot - (i == j ? 1.0 : 0.0)) < 0.01)) return false;
    }
  return true;
}

}  // namespace

Result<std::optional<MountMatrix>> parse_mount_matrix(std::string_view text) {
  const auto matrix = nine_numbers(text);
  if (!matrix || !is_orthonormal(*matrix))
    return Error{Errc::corrupt,
                 fmt::format("mount matrix \"{}\": expected three orthonormal rows such as 0, 1, "
                             "0; -1, 0, 0; 0, 0, 1",
                             text)};
  if (*matrix == identity) return std::optional<MountMatrix>();
  return matrix;
}

void turn(const MountMatrix& m,
          std::vector<double>& x,
          std::vector<double>& y,
          std::vector<double>& z) {
  for (std::size_t k = 0; k < x.size(); ++k) {
    const std::array<double, 3> chip{x[k], y[k], z[k]};
    x[k] = m[0] * chip[0] + m[1] * chip[1] + m[2] * chip[2];
    y[k] = m[3] * chip[0] + m[4] * chip[1] + m[5] * chip[2];
    z[k] = m[6] * chip[0] + m[7] * chip[1] + m[8] * chip[2];
  }
}

}  // namespace proofmass::acquire
