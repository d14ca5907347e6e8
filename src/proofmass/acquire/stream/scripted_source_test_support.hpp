#pragma once

#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "proofmass/acquire/recorder.hpp"

namespace proofmass::acquire {

/// Action of a scripted source at one read.
struct Act {
  enum class Kind { rows, nothing, fail, end } kind = Kind::rows;
  std::size_t rows = 10;
  std::uint64_t lost_before = 0;
  std::uint64_t uncounted = 0;  ///< rows lost before it without the source's knowledge
  double wait_s = 0.0;          ///< actual delay before it
  std::vector<Note> notes{};
};

/// Contents of a script: row k of channel c is 1000 c + k, 100 rows a second.
struct Script {
  std::vector<Act> acts{};
  bool has_device_clock = true;
  bool is_paced = false;
  bool counts_rows = false;
  double rate_hz = 100.0;
  std::size_t channels = 2;
  std::function<double(std::uint64_t row, std::size_t channel)> value{};
  /// The device's clock; a row's host time is the same except in a real-time script.
  std::function<std::int64_t(std::uint64_t row)> device_ns{};
  /// Arrival of a row, if it is not the actual time.
  std::function<std::int64_t(std::uint64_t row)> host_ns{};
};

inline SourceHead head_of(const Script& script) {
  SourceHead head;
  head.recording.source = "script:";
  head.recording.format = "script";
  head.recording.time.rate_hz = script.rate_hz;
  for (std::size_t c = 0; c < script.channels; ++c)
    head.recording.channels.push_back(
        {"acc_" + std::string(1, static_cast<char>('x' + c)), *parse_unit("m/s^2"), {}});
  head.has_device_clock = script.has_device_clock;
  head.is_paced = script.is_paced;
  head.settings = {{"range", "±2 g"}};
  return head;
}

/// Plays a script; rows are numbered over all sources that share a counter.
class ScriptedSource final : public Source {
 public:
  ScriptedSource(Script script, std::shared_ptr<std::uint64_t> row)
      : script_(std::move(script)), head_(head_of(script_)), row_(std::move(row)) {}

  [[nodiscard]] const SourceHead& head() const override { return head_; }
  [[nodiscard]] Result<Arrived> read(Arrival& arrival,
                                     std::chrono::milliseconds patience) override {
    arrival.clear(script_.channels);
    if (next_ == script_.acts.size()) return Arrived::ended;
    const Act act = script_.acts[next_];
    if (act.wait_s > waited_s_) {
      const double wait_s =
          std::min(act.wait_s - waited_s_, std::chrono::duration<double>(patience).count());
      std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
      waited_s_ += wait_s;
      if (act.wait_s > waited_s_) return Arrived::nothing;
    }
    waited_s_ = 0.0;
    ++next_;
    arrival.notes = act.notes;
    if (act.kind == Act::Kind::fail) return Error{Errc::device, "the cable is pulled"};
    if (act.kind == Act::Kind::end) return Arrived::ended;
    if (act.kind == Act::Kind::nothing) return Arrived::nothing;
    arrival.lost_before = act.lost_before;
    *row_ += act.lost_before;
    if (script_.counts_rows) arrival.first_count = static_cast<double>(*row_ + act.uncounted);
    *row_ += act.uncounted;
    for (std::size_t i = 0; i < act.rows; ++i) add_row(arrival);
    arrival.host_ns = host_ns(*row_ - 1);
    if (script_.counts_rows) arrival.last_count = static_cast<double>(*row_ - 1);
    return Arrived::rows;
  }

 private:
  [[nodiscard]] std::int64_t device_ns(std::uint64_t row) const {
    if (script_.device_ns) return script_.device_ns(row);
    return 5'000'000'000 + static_cast<std::int64_t>(row) * 10'000'000;
  }
  [[nodiscard]] std::int64_t host_ns(std::uint64_t row) const {
    if (script_.host_ns) return script_.host_ns(row);
    return script_.is_paced ? host_now_ns() : device_ns(row);
  }
  void add_row(Arrival& arrival) {
    const std::uint64_t row = (*row_)++;
    for (std::size_t c = 0; c < script_.channels; ++c)
      arrival.channels[c].push_back(script_.value ? script_.value(row, c)
                                                  : 1000.0 * static_cast<double>(c) +
                                                        static_cast<double>(row));
    if (script_.has_device_clock) arrival.device_ns.push_back(device_ns(row));
  }

  Script script_;
  SourceHead head_;
  std::shared_ptr<std::uint64_t> row_;
  std::size_t next_ = 0;
  double waited_s_ = 0.0;
};

/// Opens the scripts one after another; after the last, opening fails.
inline OpenSource open_scripts(std::vector<Script> scripts) {
  auto left = std::make_shared<std::deque<Script>>(scripts.begin(), scripts.end());
  auto row = std::make_shared<std::uint64_t>(0);
  return [left, row]() -> Result<std::unique_ptr<Source>> {
    if (left->empty()) return Error{Errc::device, "is not there"};
    Script script = left->front();
    left->pop_front();
    return std::unique_ptr<Source>(std::make_unique<ScriptedSource>(std::move(script), row));
  };
}

inline std::vector<Act> arrivals(std::size_t count, const Act& act = {}) {
  return std::vector<Act>(count, act);
}

/// A temporary folder for a test's files.
class TestFolder {
 public:
  TestFolder() {
    std::string name =
        (std::filesystem::temp_directory_path() / "proofmass-record-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace proofmass::acquire
