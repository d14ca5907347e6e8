#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <semaphore>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "proofmass/estimate/filter/bryson_frazier.hpp"
#include "proofmass/estimate/filter/kalman_filter.hpp"

// The fixed-interval smoother under every model of this module, linear or extended: the filter of
// filter/kalman_filter.hpp forwards, filter/bryson_frazier.hpp backwards.
namespace proofmass::estimate {

/// For each chunk, the last first: rerun(chunk, steps), on a second thread during go_back(chunk,
/// steps) of the next.
template <class Step, class Rerun, class GoBack>
void go_back_with_a_thread(std::size_t chunks,
                           std::size_t chunk,
                           const Rerun& rerun,
                           const GoBack& go_back) {
  std::array steps{std::vector<Step>(chunk), std::vector<Step>(chunk)};  // of even and odd chunks
  std::counting_semaphore<> free(2), ready(0);
  const std::jthread ahead([&](const std::stop_token& stop) {
    const std::stop_callback wake(stop, [&] { free.release(); });
    for (std::size_t c = chunks; c-- > 0;) {
      free.acquire();
      if (stop.stop_requested()) return;
      rerun(c, steps[c % 2]);
      ready.release();
    }
  });
  for (std::size_t c = chunks; c-- > 0;) {
    ready.acquire();
    go_back(c, steps[c % 2]);
    free.release();
  }
}

/// Forward and backward pass over `size` epochs: advance(state, k, step) and forward(k, step) for
/// each, then backward(k, step) in falling k. The forward pass stores the state at every `chunk`-th
/// epoch, `shortest` or as many as make 4096 states; the backward pass reruns each chunk, so that
/// memory is O(size / chunk + chunk) states and steps instead of one step for each epoch. A long
/// run reruns each chunk on a second thread during backward() of the next.
template <class Step,
          std::size_t shortest,
          class State,
          class Advance,
          class Forward,
          class Backward>
void there_and_back(
    std::size_t size, State state, Advance&& advance, Forward&& forward, Backward&& backward) {
  constexpr std::size_t worth_a_thread = 4096 * shortest;
  const std::size_t chunk = std::max(shortest, size / 4096);
  std::vector<State> starts;
  starts.reserve(size / chunk + 1);
  Step now;
  for (std::size_t k = 0; k < size; ++k) {
    if (k % chunk == 0) starts.push_back(state);
    advance(state, k, now);
    forward(k, std::as_const(now));
  }
  const std::size_t chunks = starts.size();
  const auto rerun = [&](std::size_t c, std::vector<Step>& steps) {
    const std::size_t first = c * chunk, last = std::min(first + chunk, size);
    for (std::size_t k = first; k < last; ++k) advance(starts[c], k, steps[k - first]);
  };
  const auto go_back = [&](std::size_t c, const std::vector<Step>& steps) {
    const std::size_t first = c * chunk, last = std::min(first + chunk, size);
    for (std::size_t k = last; k-- > first;) backward(k, steps[k - first]);
  };
  if (size >= worth_a_thread) return go_back_with_a_thread<Step>(chunks, chunk, rerun, go_back);
  std::vector<Step> steps(std::min(chunk, size));
  for (std::size_t c = chunks; c-- > 0;) {
    rerun(c, steps);
    go_back(c, steps);
  }
}

/// smooth() and smooth_means(), with the adjoint of either.
template <class Backwards, StateSpaceModel Model, class Forward, class Backward>
void smooth_with(const Model& model,
                 const FilterState<Model::states>& prior,
                 const Gate& gate,
                 Forward&& forward,
                 Backward&& backward) {
  constexpr int N = Model::states;
  constexpr std::size_t chunk = N > 12 ? 64 : 128;
  Backwards later;
  later.active = active_states(model);
  there_and_back<StepOf<Model>, chunk>(
      model.size(), prior,
      [&](FilterState<N>& state, std::size_t k, StepOf<Model>& step) {
        advance(model, k, gate, state, step);
      },
      forward,
      [&](std::size_t k, const StepOf<Model>& step) {
        backward(k, step, std::as_const(later));
        look_back(later, step);
      });
}

/// Filter and fixed-interval smoother over all epochs of a model, in the memory of
/// there_and_back().
///
/// forward(k, step) is called in rising k, backward(k, step, information) in falling k; information
/// is the adjoint of the epochs after k. Cost: two forward passes and one backward, O(epochs · M ·
/// N²).
template <StateSpaceModel Model, class Forward, class Backward>
void smooth(const Model& model,
            const FilterState<Model::states>& prior,
            const Gate& gate,
            Forward&& forward,
            Backward&& backward) {
  smooth_with<BackwardInformation<Model::states>>(model, prior, gate, forward, backward);
}

/// The same without variances, at the cost of two forward passes: backward(k, step, score).
template <StateSpaceModel Model, class Forward, class Backward>
void smooth_means(const Model& model,
                  const FilterState<Model::states>& prior,
                  const Gate& gate,
                  Forward&& forward,
                  Backward&& backward) {
  smooth_with<BackwardScore<Model::states>>(model, prior, gate, forward, backward);
}

}  // namespace proofmass::estimate
