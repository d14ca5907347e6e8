#include "proofmass/serve/live/source.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace proofmass::serve {
namespace {

using FramePointer = std::shared_ptr<const LiveFrame>;

void keep_last(std::deque<FramePointer>& frames, const FramePointer& frame, std::size_t most) {
  frames.push_back(frame);
  if (frames.size() > most) frames.pop_front();
}

// The ends of a pipe: read, write.
Result<std::array<int, 2>> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) == 0) return ends;
  return Error{Errc::unreadable, fmt::format("no pipe: {}", std::strerror(errno))};
}

void close_both(const std::array<int, 2>& ends) {
  for (const int end : ends) ::close(end);
}

}  // namespace

Result<std::unique_ptr<LiveSource>> LiveSource::start(std::uint64_t id, ChildCommand command) {
  const auto output = make_pipe();
  if (!output) return output.error();
  const auto input = make_pipe();
  if (!input) {
    close_both(*output);
    return input.error();
  }
  command.output = (*output)[1];
  command.input = (*input)[0];
  auto process = ChildProcess::start(command);
  ::close(command.output);
  ::close(command.input);
  const Pipes own{(*output)[0], (*input)[1]};
  if (process) {
    ::fcntl(own.words, F_SETFL, O_NONBLOCK);
    return std::unique_ptr<LiveSource>(new LiveSource(id, std::move(process).value(), own));
  }
  ::close(own.lines);
  ::close(own.words);
  return process.error();
}

LiveSource::LiveSource(std::uint64_t id, ChildProcess process, Pipes pipes)
    : id_(id), process_(std::move(process)), pipes_(pipes) {
  reader_ = std::thread([this] { read_lines(); });
  follower_ = std::thread([this] { follow(); });
}

LiveSource::~LiveSource() {
  stops_ = true;
  follower_.join();
  reader_.join();
  ::close(pipes_.lines);
  ::close(pipes_.words);
}

/// Until all writers of the pipe are gone: the process's group is killed when it has ended.
void LiveSource::read_lines() {
  constexpr std::size_t longest = std::size_t{8} << 20;
  std::array<char, 65536> piece{};
  std::string line;
  for (ssize_t got = 0; (got = ::read(pipes_.lines, piece.data(), piece.size())) != 0;) {
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return;
    std::string_view bytes(piece.data(), static_cast<std::size_t>(got));
    for (std::size_t end = 0; (end = bytes.find('\n')) != std::string_view::npos;) {
      line += bytes.substr(0, end);
      bytes.remove_prefix(end + 1);
      take_line(std::exchange(line, {}));
    }
    if (line.size() + bytes.size() <= longest) line += bytes;
  }
}

void LiveSource::follow() {
  constexpr std::size_t most_messages = 200;
  const ChildEnd end = process_.follow(
      [this](std::string_view line) {
        const std::lock_guard lock(mutex_);
        if (messages_.size() < most_messages) messages_.emplace_back(line);
      },
      [this] { return stops_.load(); });
  const std::lock_guard lock(mutex_);
  end_ = end;
}

void LiveSource::take_line(std::string line) {
  const FramePointer frame = frame_of(std::move(line));
  if (!frame) return;
  const std::lock_guard lock(mutex_);
  keep(frame);
  for (const auto& one : listeners_)
    if (const auto listener = one.lock()) listener->take(id_, frame);
  std::erase_if(listeners_, [](const auto& one) { return one.expired(); });
}

void LiveSource::keep(const FramePointer& frame) {
  constexpr std::size_t most_events = 50, most_noise = 6, most_recent = 600;
  if (frame->kind == "rows" || frame->kind == "estimates")
    return keep_last(recent_, frame, most_recent);
  if (frame->kind == "event") return keep_last(events_, frame, most_events);
  if (frame->kind == "noise") return keep_last(noise_, frame, most_noise);
  constexpr std::size_t most_kinds = 32;
  if (latest_.size() < most_kinds || latest_.contains(frame->kind)) latest_[frame->kind] = frame;
}

void LiveSource::listen(const std::shared_ptr<LiveListener>& listener) {
  const std::lock_guard lock(mutex_);
  const auto hand_over = [&](const FramePointer& frame) {
    // The past is not what a slow browser has left out.
    auto whole = std::make_shared<LiveFrame>(*frame);
    whole->may_be_left_out = false;
    listener->take(id_, std::move(whole));
  };
  for (const char* kind : {"head", "columns"})
    if (const auto found = latest_.find(kind); found != latest_.end()) hand_over(found->second);
  for (const auto* frames : {&events_, &noise_, &recent_})
    for (const FramePointer& frame : *frames) hand_over(frame);
  for (const auto& [kind, frame] : latest_)
    if (kind != "head" && kind != "columns" && kind != "end") hand_over(frame);
  if (const auto found = latest_.find("end"); found != latest_.end()) hand_over(found->second);
  listeners_.push_back(listener);
}

void LiveSource::forget(const LiveListener* listener) {
  const std::lock_guard lock(mutex_);
  std::erase_if(listeners_, [&](const auto& one) { return one.lock().get() == listener; });
}

bool LiveSource::say(std::string_view line) {
  const std::string text = std::string(line) + "\n";
  const std::lock_guard lock(mutex_);
  return !end_ &&
         ::write(pipes_.words, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

LiveSource::Status LiveSource::status() const {
  const std::lock_guard lock(mutex_);
  Status status;
  for (const char* kind : {"head", "state", "audit", "guide", "end"})
    if (const auto found = latest_.find(kind); found != latest_.end())
      status.latest[kind] = found->second->json;
  status.messages = messages_;
  status.end = end_;
  status.stops = stops_;
  return status;
}

}  // namespace proofmass::serve
