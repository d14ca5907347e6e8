#include "proofmass/calibrate/tumble/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace proofmass::calibrate {
namespace {

constexpr double alike_rad = 0.5 * std::numbers::pi / 180.0;  // tolerance for two visits of one
                                                              // setting
constexpr double least_of_its_own = 0.05;  // rms of the part of a column that is orthogonal to
                                           // the fitted ones

double turn_part(double angle_rad) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double part = std::fmod(angle_rad, turn);
  return part < 0.0 ? part + turn : part;
}

bool alike(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi)) < alike_rad;
}

std::size_t mounting_of(const TumblePosition& position, std::vector<TumbleMounting>& mountings) {
  const auto same = [&](const TumbleMounting& m) {
    return m.plane == position.plane && alike(m.mount_rad, position.mount_rad);
  };
  const auto found = std::find_if(mountings.begin(), mountings.end(), same);
  const auto place = static_cast<std::size_t>(found - mountings.begin());
  if (found == mountings.end())
    mountings.push_back({position.plane, turn_part(position.mount_rad)});
  return place;
}

// Numbers the settings: angles within half a degree of each other (modulo a turn) have the same
// number.
std::vector<std::size_t> settings(View<TumblePosition> positions) {
  std::vector<std::size_t> order(positions.size()), setting(positions.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto at = [&](std::size_t k) { return turn_part(positions[k].angle_rad); };
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return at(a) < at(b); });
  std::size_t number = 0;
  double begin = 0.0;
  for (std::size_t j = 0; j < order.size(); ++j) {
    if (j == 0 || at(order[j]) - begin >= alike_rad) {
      begin = at(order[j]);
      if (j > 0) ++number;
    }
    setting[order[j]] = number;
  }
  if (order.empty() || number == 0 || !alike(at(order.front()), at(order.back()))) return setting;
  for (std::size_t& s : setting)
    if (s == number) s = 0;
  return setting;
}

void clock(View<TumblePosition> positions, TumbleDesign& design) {
  design.in_time = std::all_of(positions.begin(), positions.end(),
                               [](const TumblePosition& p) { return p.time_s.has_value(); });
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    design.when.push_back(design.in_time ? *positions[k].time_s : static_cast<double>(k));
    first = std::min(first, design.when.back());
    last = std::max(last, design.when.back());
  }
  for (double& when : design.when) when -= first;
  design.span = positions.empty() ? 0.0 : last - first;
}

// For one mounting: its duration, and the longest time between two visits of one setting.
struct Stay {
  double whole = 0.0, between = 0.0;
};

Stay stay_of(std::size_t mounting, const std::vector<std::size_t>& of, const TumbleDesign& design) {
  Stay out;
  for (std::size_t j = 0; j < of.size(); ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      if (of[j] != mounting || of[k] != mounting) continue;
      const double apart = std::abs(design.when[j] - design.when[k]);
      out.whole = std::max(out.whole, apart);
      if (design.setting[j] == design.setting[k]) out.between = std::max(out.between, apart);
    }
  }
  return out;
}

// True if in one mounting two visits of a setting are at least half of its duration apart.
bool is_closed(const std::vector<std::size_t>& mounting, const TumbleDesign& design) {
  for (std::size_t m = 0; m < design.mountings.size(); ++m) {
    const Stay stay = stay_of(m, mounting, design);
    if (stay.between > 0.0 && stay.between >= 0.5 * stay.whole) return true;
  }
  return false;
}

// Variables of one position on which the columns depend.
struct Row {
  double phi, theta, when, temperature;
  int plane, direction;
  std::size_t mounting;
};

double element(const TumbleColumn& column, const Row& row) {
  const double c = std::cos(row.phi), way = 0.5 * row.direction;
  if (column.plane != 0 && column.plane != row.plane) return 0.0;
  switch (column.term) {
    case TumbleTerm::up_down:
      return 1.0;
    case TumbleTerm::sine:
      return std::sin(row.phi);
    case TumbleTerm::cosine:
      return column.mounting == row.mounting ? c : 0.0;
    case TumbleTerm::square:
      return 2.0 * c * c;
    case TumbleTerm::product:
      return 2.0 * c * std::sin(row.phi);
    case TumbleTerm::cube:
      return std::sin(3.0 * row.phi);
    case TumbleTerm::third_cosine:
      return std::cos(3.0 * row.phi);
    case TumbleTerm::drift:
      return row.when;
    case TumbleTerm::temperature:
      return row.temperature;
    case TumbleTerm::hysteresis:
      return way;
    case TumbleTerm::backlash:
      return way * c;
    case TumbleTerm::indexing_cos:
      return c * std::cos(row.theta);
    case TumbleTerm::indexing_sin:
      return c * std::sin(row.theta);
    case TumbleTerm::indexing_cos2:
      return c * std::cos(2.0 * row.theta);
    case TumbleTerm::indexing_sin2:
      return c * std::sin(2.0 * row.theta);
  }
  return 0.0;
}

// Sequential choice of columns, with an orthonormal basis of their span.
class Selection {
 public:
  Selection(std::vector<Row> rows, TumbleDesign& design)
      : rows_(std::move(rows)), design_(design) {}

  // `spare`: minimum redundancy that must remain.
  void offer(const TumbleColumn& column, std::size_t spare) {
    const auto n = static_cast<Eigen::Index>(rows_.size());
    Eigen::VectorXd a(n);
    for (Eigen::Index k = 0; k < n; ++k) a(k) = element(column, rows_[static_cast<std::size_t>(k)]);
    Eigen::VectorXd own = a;
    for (int pass = 0; pass < 2; ++pass)  // reorthogonalisation: two passes suffice
      for (const Eigen::VectorXd& q : basis_) own -= q.dot(own) * q;
    const double rms = own.norm() / std::sqrt(static_cast<double>(n));
    if (rms < least_of_its_own) {
      design_.missing.push_back({column, LeftOut::not_separable});
    } else if (columns_.size() + 1 + spare > rows_.size()) {
      design_.missing.push_back({column, LeftOut::none_to_spare});
    } else {
      basis_.push_back(own / own.norm());
      columns_.push_back(a);
      design_.columns.push_back(column);
    }
  }

  void not_asked_for(TumbleTerm term) {
    design_.missing.push_back({{.term = term}, LeftOut::not_asked_for});
  }

  [[nodiscard]] Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd A(static_cast<Eigen::Index>(rows_.size()),
                      static_cast<Eigen::Index>(columns_.size()));
    for (std::size_t j = 0; j < columns_.size(); ++j)
      A.col(static_cast<Eigen::Index>(j)) = columns_[j];
    return A;
  }

 private:
  std::vector<Row> rows_;
  TumbleDesign& design_;
  std::vector<Eigen::VectorXd> basis_, columns_;
};

// Minimum redundancy after adding a term: for a parameter, and for a term that only tests the
// model.
constexpr std::size_t one_to_spare = 1, test_to_spare = 3;

void choose(View<TumblePosition> positions,
            const std::vector<int>& planes,
            bool noise_known,
            Selection& select,
            const TumbleDesign& design) {
  const auto went = [&](int way) {
    return std::any_of(positions.begin(), positions.end(),
                       [&](const TumblePosition& p) { return p.direction == way; });
  };
  select.offer({.term = TumbleTerm::sine}, 0);
  select.offer({.term = TumbleTerm::up_down}, 0);
  for (std::size_t m = 0; m < design.mountings.size(); ++m)
    select.offer({TumbleTerm::cosine, design.mountings[m].plane, m}, 0);
  for (const int plane : planes) select.offer({TumbleTerm::square, plane}, 0);
  if (design.kelvin_span > 0.0)
    select.offer({.term = TumbleTerm::temperature}, one_to_spare);
  else
    select.not_asked_for(TumbleTerm::temperature);
  // Two visits of one setting determine a drift even without redundancy.
  if (design.closed)
    select.offer({.term = TumbleTerm::drift}, noise_known ? 0 : one_to_spare);
  else
    select.not_asked_for(TumbleTerm::drift);
  for (const TumbleTerm term : {TumbleTerm::backlash, TumbleTerm::hysteresis})
    went(1) && went(-1) ? select.offer({.term = term}, one_to_spare) : select.not_asked_for(term);
  const bool anew = design.mountings.size() > planes.size();
  const auto offer_indexing = [&](std::initializer_list<TumbleTerm> terms) {
    for (const TumbleTerm term : terms)
      anew ? select.offer({.term = term}, one_to_spare) : select.not_asked_for(term);
  };
  offer_indexing({TumbleTerm::indexing_cos});
  for (const int plane : planes) select.offer({TumbleTerm::product, plane}, one_to_spare);
  offer_indexing({TumbleTerm::indexing_sin});
  select.offer({.term = TumbleTerm::cube}, one_to_spare);
  for (const int plane : planes) select.offer({TumbleTerm::third_cosine, plane}, test_to_spare);
  offer_indexing({TumbleTerm::indexing_cos2, TumbleTerm::indexing_sin2});
}

// (T − T̄)/span; zeros if one temperature is missing or all are equal.
std::vector<double> relative_temperatures(View<TumblePosition> positions, double& span) {
  std::vector<double> out(positions.size(), 0.0);
  span = 0.0;
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0;
  for (const TumblePosition& p : positions) {
    if (!p.temperature || !std::isfinite(*p.temperature)) return out;
    low = std::min(low, *p.temperature);
    high = std::max(high, *p.temperature);
    sum += *p.temperature;
  }
  if (!(high > low)) return out;
  span = high - low;
  const double mean = sum / static_cast<double>(positions.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = (*positions[k].temperature - mean) / span;
  return out;
}

std::vector<int> planes_of(const TumbleDesign& design) {
  std::vector<int> planes;
  for (const int plane : {1, 2}) {
    if (std::any_of(design.mountings.begin(), design.mountings.end(),
                    [&](const TumbleMounting& m) { return m.plane == plane; }))
      planes.push_back(plane);
  }
  return planes;
}

}  // namespace

std::optional<std::size_t> TumbleDesign::find(TumbleTerm term,
                                              int plane,
                                              std::size_t mounting) const {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const TumbleColumn& column = columns[k];
    const bool here = plane == 0 || column.plane == plane;
    if (column.term == term && here && column.mounting == mounting) return k;
  }
  return std::nullopt;
}

std::optional<LeftOut> TumbleDesign::why_not(TumbleTerm term, int plane) const {
  for (const TumbleMissing& column : missing) {
    if (column.column.term == term && (plane == 0 || column.column.plane == plane))
      return column.why;
  }
  return std::nullopt;
}

Eigen::MatrixXd drift_shapes(const TumbleDesign& design, double higher) {
  constexpr Eigen::Index most = 6;
  const auto n = static_cast<Eigen::Index>(design.when.size());
  if (!(design.span > 0.0)) return Eigen::MatrixXd::Zero(n, 0);
  const bool line = !design.closed;
  const Eigen::Index multiples = higher > 0.0 ? most : 1;
  Eigen::MatrixXd shapes(n, 2 * multiples + (line ? 1 : 0));
  for (Eigen::Index k = 0; k < n; ++k) {
    const double part = design.when[static_cast<std::size_t>(k)] / design.span;
    for (Eigen::Index m = 1; m <= multiples; ++m) {
      const auto times = static_cast<double>(m);
      const double size = m == 1 ? 1.0 : higher / times;
      shapes(k, 2 * m - 2) = size * std::cos(2.0 * std::numbers::pi * times * part);
      shapes(k, 2 * m - 1) = size * std::sin(2.0 * std::numbers::pi * times * part);
    }
    if (line) shapes(k, 2 * multiples) = 2.0 * (part - 0.5);
  }
  return shapes;
}

TumbleDesign design_tumble(View<TumblePosition> positions,
                           const std::array<double, 2>& phase_rad,
                           bool noise_known) {
  TumbleDesign design;
  design.setting = settings(positions);
  clock(positions, design);
  std::vector<std::size_t> mounting;
  for (const TumblePosition& p : positions) mounting.push_back(mounting_of(p, design.mountings));
  design.closed = is_closed(mounting, design);
  double mean = 0.0;
  for (const double when : design.when) mean += when / static_cast<double>(positions.size());
  const std::vector<double> temperature = relative_temperatures(positions, design.kelvin_span);
  std::vector<Row> rows;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const TumblePosition& p = positions[k];
    const double phase = phase_rad[p.plane == 2 ? 1 : 0];
    design.phi_rad.push_back(p.angle_rad + p.mount_rad + phase);
    const double when = design.span > 0.0 ? (design.when[k] - mean) / design.span : 0.0;
    rows.push_back({design.phi_rad.back(), p.angle_rad, when, temperature[k], p.plane, p.direction,
                    mounting[k]});
  }
  Selection select(std::move(rows), design);
  choose(positions, planes_of(design), noise_known, select, design);
  design.A = select.matrix();
  return design;
}

}  // namespace proofmass::calibrate
