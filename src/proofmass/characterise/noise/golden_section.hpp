#pragma once

namespace proofmass::characterise {

/// Search interval and tolerance of a minimum.
struct Bracket {
  double low = 0.0, high = 0.0, tolerance = 0.0;
};

struct Least {
  double place = 0.0, value = 0.0;
};

/// The minimum of a function that is unimodal in the bracket. Source: J. Kiefer, Proc. Amer. Math.
/// Soc. 4 (1953) 502.
template <class Function>
[[nodiscard]] Least least_between(Bracket bracket, const Function& f) {
  constexpr double golden = 0.6180339887498949;
  double a = bracket.high - golden * (bracket.high - bracket.low);
  double b = bracket.low + golden * (bracket.high - bracket.low);
  double at_a = f(a), at_b = f(b);
  while (bracket.high - bracket.low > bracket.tolerance) {
    if (at_a < at_b) {
      bracket.high = b;
      b = a;
      at_b = at_a;
      a = bracket.high - golden * (bracket.high - bracket.low);
      at_a = f(a);
    } else {
      bracket.low = a;
      a = b;
      at_a = at_b;
      b = bracket.low + golden * (bracket.high - bracket.low);
      at_b = f(b);
    }
  }
  return at_a < at_b ? Least{a, at_a} : Least{b, at_b};
}

}  // namespace proofmass::characterise
