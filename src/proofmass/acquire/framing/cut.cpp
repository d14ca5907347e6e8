#include "proofmass/acquire/framing/cut.hpp"

#include <algorithm>
#include <utility>

namespace proofmass::acquire {
namespace {

/// Decodes the bytes between two delimiters; false if they are damaged.
using Unstuff = bool (*)(std::string_view stuffed, std::string& out);

bool unstuff_cobs(std::string_view stuffed, std::string& out) {
  out.clear();
  while (!stuffed.empty()) {
    const std::size_t code = static_cast<unsigned char>(stuffed.front());
    if (code == 0 || code > stuffed.size()) return false;
    out += stuffed.substr(1, code - 1);
    stuffed.remove_prefix(code);
    constexpr std::size_t without_zero = 0xFF;
    if (code != without_zero && !stuffed.empty()) out += '\0';
  }
  return true;
}

constexpr char slip_end = '\xC0';

bool unstuff_slip(std::string_view stuffed, std::string& out) {
  constexpr char escape = '\xDB';
  out.clear();
  for (std::size_t i = 0; i < stuffed.size(); ++i) {
    if (stuffed[i] != escape) {
      out += stuffed[i];
      continue;
    }
    if (++i == stuffed.size()) return false;
    if (stuffed[i] != '\xDC' && stuffed[i] != '\xDD') return false;
    out += stuffed[i] == '\xDC' ? slip_end : escape;
  }
  return true;
}

/// Frames terminated by a delimiter that does not occur in them.
class MarkCutter final : public FrameCutter {
 public:
  MarkCutter(char mark, Unstuff unstuff, std::size_t frame_bytes)
      : mark_(mark), unstuff_(unstuff), frame_bytes_(frame_bytes) {}

  void take(std::string_view bytes, FrameSink& sink) override {
    while (!bytes.empty()) {
      const std::size_t end = std::min(bytes.find(mark_), bytes.size());
      keep(bytes.substr(0, end), sink);
      if (end == bytes.size()) return;
      close(sink);
      bytes.remove_prefix(end + 1);
    }
  }
  void finish(FrameSink& sink) override {
    if (const std::size_t rest = std::exchange(skipped_, 0) + stuffed_.size(); rest > 0)
      sink.skipped(rest, 0, false);
    stuffed_.clear();
  }

 private:
  /// A stuffed frame is at most twice its length.
  void keep(std::string_view bytes, FrameSink& sink) {
    const std::size_t longest = 2 * frame_bytes_ + 2;
    if (skipped_ == 0 && stuffed_.size() + bytes.size() <= longest) {
      stuffed_ += bytes;
      return;
    }
    skipped_ += stuffed_.size() + bytes.size();
    stuffed_.clear();
    constexpr std::size_t worth_reporting = 65'536;
    if (skipped_ < worth_reporting) return;
    sink.skipped(skipped_ - 1, lost_in(skipped_), false);
    skipped_ = 1;
  }
  void close(FrameSink& sink) {
    const std::size_t bytes = std::exchange(skipped_, 0) + stuffed_.size();
    const bool fits =
        bytes == stuffed_.size() && unstuff_(stuffed_, frame_) && frame_.size() == frame_bytes_;
    stuffed_.clear();
    if (bytes == 0) return;
    const bool is_sound = fits && sink.is_sound(frame_);
    if (is_sound) sink.frame(frame_);
    // The frame before the first delimiter began before the stream was opened.
    else
      sink.skipped(bytes + 1, has_begun_ ? lost_in(bytes) : 0, fits && has_begun_);
    has_begun_ = true;
  }
  [[nodiscard]] std::size_t lost_in(std::size_t bytes) const {
    return std::max<std::size_t>(1, bytes / (frame_bytes_ + 2));
  }

  char mark_;
  Unstuff unstuff_;
  std::size_t frame_bytes_;
  bool has_begun_ = false;
  std::string stuffed_, frame_;
  std::size_t skipped_ = 0;  ///< bytes up to the next delimiter that exceed a frame
};

class SyncCutter final : public FrameCutter {
 public:
  SyncCutter(std::string word, std::size_t frame_bytes, bool has_check)
      : word_(std::move(word)), frame_bytes_(frame_bytes), has_check_(has_check) {}

  void take(std::string_view bytes, FrameSink& sink) override {
    buffer_ += bytes;
    std::string_view rest = buffer_;
    while (step(rest, sink)) {
    }
    buffer_.erase(0, buffer_.size() - rest.size());
  }
  void finish(FrameSink& sink) override {
    // The last frame has no successor to confirm it.
    if (!has_check_ && has_begun_ && passed_ == 0 && buffer_.starts_with(word_) &&
        buffer_.size() >= whole()) {
      sink.frame(std::string_view(buffer_).substr(word_.size(), frame_bytes_));
      buffer_.erase(0, whole());
    }
    passed_ += buffer_.size();
    buffer_.clear();
    report(sink);
  }

 private:
  [[nodiscard]] std::size_t whole() const { return word_.size() + frame_bytes_; }

  /// Takes a frame, or skips bytes that are not one; false if more bytes are needed.
  bool step(std::string_view& rest, FrameSink& sink) {
    const std::size_t at = rest.find(word_);
    if (at == std::string_view::npos) {
      // The word may begin in the last bytes.
      pass(rest, rest.size() - std::min(rest.size(), word_.size() - 1), sink);
      return false;
    }
    pass(rest, at, sink);
    if (rest.size() < whole() + (has_check_ ? 0 : word_.size())) return false;
    const std::string_view frame = rest.substr(word_.size(), frame_bytes_);
    const bool is_confirmed = has_check_ || rest.substr(whole()).starts_with(word_);
    if (!is_confirmed || !sink.is_sound(frame)) {
      by_checksum_ = by_checksum_ || (has_begun_ && passed_ == 0 && is_confirmed);
      pass(rest, 1, sink);
      return true;
    }
    report(sink);
    sink.frame(frame);
    has_begun_ = true;
    rest.remove_prefix(whole());
    return true;
  }
  void pass(std::string_view& rest, std::size_t bytes, FrameSink& sink) {
    rest.remove_prefix(bytes);
    passed_ += bytes;
    constexpr std::size_t worth_reporting = 65'536;
    if (passed_ >= worth_reporting) report(sink);
  }
  void report(FrameSink& sink) {
    const std::size_t bytes = std::exchange(passed_, 0);
    const bool by_checksum = std::exchange(by_checksum_, false);
    // The frame before the first sync word began before the stream was opened.
    if (bytes > 0)
      sink.skipped(bytes,
                   has_begun_ ? std::max<std::size_t>(1, (bytes + whole() / 2) / whole()) : 0,
                   by_checksum);
  }

  std::string word_;
  std::size_t frame_bytes_;
  bool has_check_;
  bool has_begun_ = false, by_checksum_ = false;
  std::string buffer_;
  std::size_t passed_ = 0;
};

}  // namespace

std::unique_ptr<FrameCutter> cobs_cutter(std::size_t frame_bytes) {
  return std::make_unique<MarkCutter>('\0', unstuff_cobs, frame_bytes);
}

std::unique_ptr<FrameCutter> slip_cutter(std::size_t frame_bytes) {
  return std::make_unique<MarkCutter>(slip_end, unstuff_slip, frame_bytes);
}

std::unique_ptr<FrameCutter> sync_cutter(std::string word,
                                         std::size_t frame_bytes,
                                         bool has_check) {
  return std::make_unique<SyncCutter>(std::move(word), frame_bytes, has_check);
}

}  // namespace proofmass::acquire
