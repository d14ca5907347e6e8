#pragma once

#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/recorder.hpp"
#include "proofmass/io/read_recording.hpp"

namespace proofmass::acquire {

inline std::string all_notes(const Recording& recording) {
  std::string all;
  for (const Note& note : recording.notes) all += note.text + "\n";
  return all;
}

inline Recording read_back(const std::string& path, const std::string& topic = {}) {
  io::ReadOptions options;
  if (!topic.empty()) options.variables = {topic};
  auto read = io::read_recording(path, options);
  if (!read) ADD_FAILURE() << read.error().message;
  return read ? std::move(read).value() : Recording{};
}

/// Twice the first channel, for the given number of rows.
class Doubler final : public LiveAnalysis {
 public:
  explicit Doubler(std::size_t most) : left_(most) {}
  [[nodiscard]] const std::vector<Channel>& columns() const override { return columns_; }
  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    if (samples.rows() > left_) return Error{Errc::not_finite, "it has had enough"};
    left_ -= samples.rows();
    for (std::size_t i = 0; i < samples.rows(); ++i) {
      out.stamps_s.push_back(samples.stamps_s[i]);
      out.channels[0].push_back(2.0 * samples.channels[0][i]);
    }
    return Done{};
  }
  [[nodiscard]] Status finish(Rows&) override { return Done{}; }
  [[nodiscard]] std::vector<Note> take_notes() override { return {}; }

 private:
  std::vector<Channel> columns_{{"acceleration", *parse_unit("m/s^2"), {}}};
  std::size_t left_;
};

inline Result<std::unique_ptr<LiveAnalysis>> doubled(const SourceHead&) {
  return std::unique_ptr<LiveAnalysis>(std::make_unique<Doubler>(1'000'000'000));
}

}  // namespace proofmass::acquire
