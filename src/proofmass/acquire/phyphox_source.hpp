#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/acquire/http_client.hpp"
#include "proofmass/acquire/phyphox_cursor.hpp"
#include "proofmass/acquire/phyphox_plan.hpp"
#include "proofmass/acquire/sensor_merge.hpp"
#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// What was agreed on with the phone before its first samples.
struct PhyphoxStart {
  std::vector<PhyphoxGroup> groups;
  std::vector<PhyphoxCursor> cursors;  ///< one a group
  std::string session;
};

/// Asks phyphox twenty times a second for what its buffers have got.
class PhyphoxSource : public Source {
 public:
  PhyphoxSource(std::unique_ptr<HttpClient> client, PhyphoxStart start, SourceHead head);

  [[nodiscard]] const SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds patience) override;

 private:
  using Clock = std::chrono::steady_clock;

  void ask();
  [[nodiscard]] Status take(const HttpAnswer& answer);
  [[nodiscard]] Status take_bad(std::string why);
  [[nodiscard]] Status take_session(const PhyphoxReply& reply);
  void take_ends(const PhyphoxReply& reply);
  void take_rows(PhyphoxReply& reply);
  void take_group(std::size_t group, std::vector<double>* columns);
  void tell(Severity severity, std::string text) { notes_.push_back({severity, std::move(text)}); }

  std::unique_ptr<HttpClient> client_;
  PhyphoxStart start_;
  SourceHead head_;
  SensorMerge merge_;
  std::vector<std::string> names_, times_;  ///< of all buffers; of those that hold times
  std::string ends_target_;                 ///< asks for the times' ends
  PhyphoxReply reply_{};
  std::vector<double> row_{};
  std::vector<Note> notes_{};
  Clock::time_point next_question_{}, last_rows_{};
  bool asks_ends_ = false;     ///< the question under way
  bool is_searching_ = false;  ///< so does one for what a clock that was set back hides
  bool is_behind_ = false;     ///< rows wait for the next answer
  bool was_measuring_ = true;
  int bad_answers_ = 0;  ///< in a row
  bool told_timeless_ = false;
};

}  // namespace proofmass::acquire
