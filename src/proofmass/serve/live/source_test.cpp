#include "proofmass/serve/live/source.hpp"

#include <chrono>
#include <csignal>
#include <gtest/gtest.h>

namespace proofmass::serve::live_source_test {
namespace {

using namespace std::chrono_literals;

// A stand-in for a recorder.
std::unique_ptr<LiveSource> shell(const std::string& script) {
  return LiveSource::start(
             3, {.arguments = {"/bin/sh", "-c", script}, .folder = "/", .environment = {}})
      .value();
}

class Listener : public LiveListener {
 public:
  void take(std::uint64_t source, std::shared_ptr<const LiveFrame> frame) override {
    const std::lock_guard lock(mutex_);
    EXPECT_EQ(source, 3U);
    kinds_.push_back(frame->kind);
  }
  [[nodiscard]] std::vector<std::string> kinds() const {
    const std::lock_guard lock(mutex_);
    return kinds_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> kinds_;
};

template <class Condition>
bool comes_true(Condition condition) {
  for (int k = 0; k < 6000; ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST(LiveSource, WhoComesLateSeesWhatWentBefore) {
  const auto source = shell(
      R"(printf '{"head":{}}\n{"rows":{}}\n{"state":{}}\n'; read word; printf '{"rows":{}}\n{"end":{}}\n')");
  ASSERT_TRUE(comes_true([&] { return source->status().latest.contains("state"); }));
  const auto late = std::make_shared<Listener>();
  source->listen(late);
  EXPECT_EQ(late->kinds(), (std::vector<std::string>{"head", "rows", "state"}));
  EXPECT_TRUE(source->say("go"));
  EXPECT_TRUE(comes_true([&] { return late->kinds().size() == 5; }));
  EXPECT_EQ(late->kinds().back(), "end");
}

TEST(LiveSource, ACrashEndsItAndNothingElse) {
  const auto source = shell(R"(printf '{"head":{}}\n'; echo why >&2; kill -SEGV $$)");
  ASSERT_TRUE(comes_true([&] { return source->status().end.has_value(); }));
  EXPECT_EQ(source->status().end->signal, SIGSEGV);
  EXPECT_EQ(source->status().messages, std::vector<std::string>{"why"});
  EXPECT_FALSE(source->say("go"));
}

TEST(LiveSource, LinesThatAreNoneArePassedOver) {
  const auto source = shell(R"(printf 'nonsense\n{"rows":\n{"head":{}}\n')");
  ASSERT_TRUE(comes_true([&] { return source->status().latest.contains("head"); }));
  EXPECT_EQ(source->status().latest.size(), 1U);
}

TEST(LiveSource, ARecorderIsAskedToEndAndMayCloseItsFile) {
  const auto source = shell(
      R"(trap 'printf "{\"end\":{}}\n"; exit 0' TERM; printf '{"head":{}}\n'; while :; do sleep 0.05; done)");
  ASSERT_TRUE(comes_true([&] { return source->status().latest.contains("head"); }));
  source->stop();
  ASSERT_TRUE(comes_true([&] { return source->status().end.has_value(); }));
  EXPECT_TRUE(comes_true([&] { return source->status().latest.contains("end"); }));
  EXPECT_EQ(source->status().end->status, 0);
}

TEST(LiveSource, AListenerThatIsGoneIsForgotten) {
  const auto source = shell(R"(printf '{"head":{}}\n'; read word; printf '{"end":{}}\n')");
  auto gone = std::make_shared<Listener>();
  const auto forgotten = std::make_shared<Listener>();
  source->listen(gone);
  source->listen(forgotten);
  source->forget(forgotten.get());
  gone.reset();
  ASSERT_TRUE(comes_true([&] { return source->status().latest.contains("head"); }));
  EXPECT_TRUE(source->say("go"));
  EXPECT_TRUE(comes_true([&] { return source->status().latest.contains("end"); }));
  for (const std::string& kind : forgotten->kinds()) EXPECT_NE(kind, "end");
}

}  // namespace
}  // namespace proofmass::serve::live_source_test
