#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "proofmass/core/view.hpp"

namespace proofmass {

/// The samples of one channel: a vector of doubles shared by its copies, or memory of another owner
/// (a NumPy array). Reading is that of a vector; a change is made through edit(), which first
/// copies what is shared or not ours. Thread-safe as a std::shared_ptr: distinct objects may be
/// used by distinct threads, also if they share their samples.
class Samples {
 public:
  Samples() = default;
  Samples(std::vector<double> values)  // NOLINT(google-explicit-constructor)
      : own_(std::make_shared<std::vector<double>>(std::move(values))) {}
  Samples(std::initializer_list<double> values) : Samples(std::vector<double>(values)) {}

  /// Samples in memory that `owner` keeps, and nobody changes, as long as they are used.
  [[nodiscard]] static Samples borrowed(View<double> values, std::shared_ptr<const void> owner) {
    Samples out;
    out.borrowed_ = {std::move(owner), values.data()};
    out.count_ = values.size();
    return out;
  }

  [[nodiscard]] const double* data() const { return own_ ? own_->data() : borrowed_.get(); }
  [[nodiscard]] std::size_t size() const {
    if (own_) return own_->size();
    return borrowed_ ? count_ : 0;
  }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] const double* begin() const { return data(); }
  [[nodiscard]] const double* end() const { return data() + size(); }
  [[nodiscard]] double operator[](std::size_t k) const { return data()[k]; }
  [[nodiscard]] double front() const { return data()[0]; }
  [[nodiscard]] double back() const { return data()[size() - 1]; }

  /// The vector for changes, valid until this object is copied, assigned or destroyed.
  [[nodiscard]] std::vector<double>& edit() {
    if (!own_ || own_.use_count() > 1) *this = Samples(std::vector<double>(begin(), end()));
    return *own_;
  }

  [[nodiscard]] std::vector<double> copy() const { return {begin(), end()}; }
  /// The vector, copied only if it is shared or not ours.
  [[nodiscard]] std::vector<double> take() && { return std::move(edit()); }

  friend bool operator==(const Samples& a, const Samples& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::shared_ptr<std::vector<double>> own_;
  std::shared_ptr<const double> borrowed_;
  std::size_t count_ = 0;  // of `borrowed_`
};

}  // namespace proofmass
