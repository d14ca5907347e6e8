#include <cmath>
#include <limits>

#include "proofmass/estimate/fast/uniform_pass.hpp"

namespace proofmass::estimate::packed {
namespace {

template <int N>
void filter_rows(Work<N>& work, const Chunk<N>& chunk, State<N>& state) {
  if (work.rows.size() < chunk.count) work.rows.resize(chunk.count);
  work.plain->filter(work.model, work.z.data() + chunk.first, chunk.count, chunk.first > 0, state,
                     work.rows.data());
  for (std::size_t t = 0; t < chunk.count; ++t) {
    const Row<N>& row = work.rows[t];
    if (row.per_S == 0.0) continue;
    ++work.score.readings;
    work.score.nis += row.y_S * row.y_S / row.per_S;
    work.score.R_S.multiply(work.model.R * row.per_S);
  }
}

template <int N>
void write_mean(const Row<N>& row, Mat<N>& mean) {
  for (int i = 0; i < N; ++i) mean(i) = row.x[i];
}

template <int N>
void write_innovation(const Row<N>& row, std::size_t k, const UniformOutput<N>& output) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const bool read = row.per_S != 0.0;
  if (!output.innovation.empty()) output.innovation[k] = read ? row.y_S / row.per_S : none;
  if (!output.innovation_variance.empty())
    output.innovation_variance[k] = read ? 1.0 / row.per_S : none;
}

template <int N>
Symmetric<N> covariance(const Row<N>& row) {
  Symmetric<N> P;
  for (std::size_t e = 0; e < P.lower.size(); ++e) P.lower[e] = row.P[e];
  return P;
}

template <int N>
void write_one_by_one(Work<N>& work, const Chunk<N>& chunk) {
  const UniformOutput<N>& out = work.output;
  for (std::size_t t = 0; t < chunk.count; ++t) {
    const std::size_t k = chunk.first + t;
    const Row<N>& row = work.rows[t];
    write_mean(row, out.means[k]);
    if (!out.covariances.empty()) out.covariances[k] = covariance(row);
    if (!out.innovation.empty() || !out.innovation_variance.empty()) write_innovation(row, k, out);
  }
  if (work.options.covariances != Covariances::where_they_change) return;
  for (std::size_t t = 0; t < chunk.count; ++t)
    work.covariances.push(covariance(work.rows[work.options.smooth ? chunk.count - 1 - t : t]));
}

}  // namespace

template <int N>
void filter_one_by_one(Work<N>& work, const Chunk<N>& chunk, State<N>& state) {
  if (work.options.smooth) {
    work.plain->filter(work.model, work.z.data() + chunk.first, chunk.count, chunk.first > 0, state,
                       nullptr);
    return;
  }
  filter_rows(work, chunk, state);
  write_one_by_one(work, chunk);
}

template <int N>
void smooth_one_by_one(Work<N>& work, const Chunk<N>& chunk, Later<N>& later) {
  State<N> state = chunk.start;
  filter_rows(work, chunk, state);
  const bool means_only = work.options.covariances == Covariances::none;
  (means_only ? work.plain->smooth_means : work.plain->smooth)(work.model, work.rows.data(),
                                                               chunk.count, later);
  write_one_by_one(work, chunk);
}

template void filter_one_by_one(Work<1>&, const Chunk<1>&, State<1>&);
template void filter_one_by_one(Work<2>&, const Chunk<2>&, State<2>&);
template void filter_one_by_one(Work<3>&, const Chunk<3>&, State<3>&);
template void filter_one_by_one(Work<4>&, const Chunk<4>&, State<4>&);
template void smooth_one_by_one(Work<1>&, const Chunk<1>&, Later<1>&);
template void smooth_one_by_one(Work<2>&, const Chunk<2>&, Later<2>&);
template void smooth_one_by_one(Work<3>&, const Chunk<3>&, Later<3>&);
template void smooth_one_by_one(Work<4>&, const Chunk<4>&, Later<4>&);

}  // namespace proofmass::estimate::packed
