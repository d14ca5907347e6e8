#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/acquire/network/http_client.hpp"
#include "proofmass/acquire/phone/phone_stream_merge.hpp"
#include "proofmass/acquire/phone/phyphox_cursor.hpp"
#include "proofmass/acquire/phone/phyphox_plan.hpp"
#include "proofmass/acquire/source.hpp"

namespace proofmass::acquire {

/// Result of the initial exchange with the phone.
struct PhyphoxStart {
  std::vector<PhyphoxGroup> groups;
  std::vector<PhyphoxCursor> cursors;  ///< one per group
  std::string session;
};

/// Polls phyphox twenty times a second for new values of the buffers.
class PhyphoxSource : public Source {
 public:
  PhyphoxSource(std::unique_ptr<HttpClient> client, PhyphoxStart start, SourceHead head);

  [[nodiscard]] const SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<Arrived> read(Arrival& arrival, std::chrono::milliseconds patience) override;

 private:
  using Clock = std::chrono::steady_clock;

  void ask();
  [[nodiscard]] Result<bool> take_next(Clock::time_point until);
  [[nodiscard]] Status take(const HttpAnswer& answer);
  [[nodiscard]] Status take_bad(std::string why);
  [[nodiscard]] Status take_session(const PhyphoxReply& reply);
  void take_ends(const PhyphoxReply& reply);
  void take_rows(PhyphoxReply& reply);
  void take_group(std::size_t group, std::vector<double>* columns);
  void report(Severity severity, std::string text) {
    notes_.push_back({severity, std::move(text)});
  }

  std::unique_ptr<HttpClient> client_;
  PhyphoxStart start_;
  SourceHead head_;
  PhoneStreamMerge merge_;
  std::vector<std::string> names_, times_;  ///< all buffers; buffers that contain times
  std::string ends_target_;                 ///< requests the ends of the times
  PhyphoxReply reply_{};
  std::vector<double> row_{};
  std::vector<Note> notes_{};
  Clock::time_point next_question_{}, last_rows_{};
  bool asks_ends_ = false;     ///< the pending request does so
  bool is_searching_ = false;  ///< the pending request searches after a clock step back
  bool is_behind_ = false;     ///< rows wait for the next response
  bool was_measuring_ = true;
  int bad_answers_ = 0;  ///< consecutive
  bool noted_timeless_ = false;
};

}  // namespace proofmass::acquire
