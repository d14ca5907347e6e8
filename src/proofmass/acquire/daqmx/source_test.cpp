// Uses rig/nidaqmx, a substitute for the driver and a USB-6009: no card of National Instruments was
// available.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

#include "proofmass/acquire/daqmx/channels.hpp"
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire::daqmx_source_test {
namespace {

using std::chrono::milliseconds;

Result<std::unique_ptr<Source>> opened(const std::string& place,
                                       const std::string& library = PROOFMASS_NIDAQMX_STANDIN) {
  OpenOptions options;
  options.nidaqmx_library = library;
  return open_source("daqmx:" + place, options);
}

std::string refusal(const std::string& place) {
  const auto source = opened(place);
  EXPECT_FALSE(source) << place;
  if (source) return {};
  EXPECT_EQ(source.error().code, Errc::device) << place;
  EXPECT_EQ(source.error().message.find('\n'), std::string::npos);
  return source.error().message;
}

std::string setting(const SourceHead& head, const std::string& key) {
  const auto found =
      std::ranges::find(head.settings, key, &std::pair<std::string, std::string>::first);
  return found != head.settings.end() ? found->second : "";
}

/// The rows received until the requested number or the end.
struct Taken {
  std::vector<std::vector<double>> channels;
  std::uint64_t lost = 0;
  std::size_t rows_before_loss = 0;
  std::vector<Note> notes;
  std::optional<Error> error;
};

Taken taken_of(Source& source, std::size_t rows) {
  Taken taken;
  taken.channels.resize(source.head().recording.channels.size());
  Arrival arrival;
  while (taken.channels.front().size() < rows) {
    const auto arrived = source.read(arrival, milliseconds(1000));
    if (!arrived) {
      taken.error = arrived.error();
      break;
    }
    if (arrival.lost_before > 0) {
      EXPECT_GT(arrival.rows(), 0U);
      taken.rows_before_loss = taken.channels.front().size();
    }
    taken.lost += arrival.lost_before;
    taken.notes.insert(taken.notes.end(), arrival.notes.begin(), arrival.notes.end());
    for (std::size_t c = 0; c < taken.channels.size(); ++c) {
      EXPECT_EQ(arrival.channels[c].size(), arrival.rows());
      taken.channels[c].insert(taken.channels[c].end(), arrival.channels[c].begin(),
                               arrival.channels[c].end());
    }
  }
  return taken;
}

/// The ramp on ai0: 1 mV per row from -1 V, quantised by the converter.
double ramp_v(std::size_t row, double step_v) {
  return std::round((-1.0 + 0.001 * static_cast<double>(row % 2000)) / step_v) * step_v;
}

void expect_ramp(const std::vector<double>& values, std::size_t first, double step_v) {
  for (std::size_t k = first; k < values.size(); ++k)
    ASSERT_NEAR(values[k], ramp_v(k - first, step_v), 1e-12) << k;
}

TEST(DaqmxChannels, AreSpeltOut) {
  EXPECT_EQ(daqmx_channels("Dev1/ai0:2, ai7,Dev2/ai4:ai3").value(),
            (std::vector<std::string>{"Dev1/ai0", "Dev1/ai1", "Dev1/ai2", "Dev1/ai7", "Dev2/ai4",
                                      "Dev2/ai3"}));
  EXPECT_EQ(daqmx_channels("cDAQ1Mod1/ai10").value(), std::vector<std::string>{"cDAQ1Mod1/ai10"});
}

TEST(DaqmxChannels, LoseTheirDeviceWhereThereIsOneOnly) {
  EXPECT_EQ(daqmx_names({"Dev1/ai0", "Dev1/ai1"}), (std::vector<std::string>{"ai0", "ai1"}));
  EXPECT_EQ(daqmx_names({"Dev1/ai0", "Dev2/ai0"}),
            (std::vector<std::string>{"Dev1/ai0", "Dev2/ai0"}));
}

TEST(DaqmxChannels, RefuseWhatNamesNone) {
  for (const char* text :
       {"", "Dev1", "ai0", "/ai0", "Dev1/", "Dev1/ai", "Dev1/0", "Dev1/ai0:", "Dev1/ai0:x",
        "Dev1/ai0,,ai1", "Dev1/ai0:99999", "Dev1/ai0:4294967296", "Dev1/ai0:2,ai1"})
    EXPECT_FALSE(daqmx_channels(text)) << text;
}

TEST(DaqmxSource, GivesWhatTheCardConverts) {
  const auto source = opened("Dev1/ai0:1?rate=5000&range=-5..5&terminal=diff").value();
  const Recording& recording = source->head().recording;
  ASSERT_EQ(recording.channels.size(), 2U);
  EXPECT_EQ(recording.channels[1].name, "ai1");
  EXPECT_EQ(recording.channels[1].unit, *parse_unit("V"));
  EXPECT_FALSE(source->head().has_device_clock);
  EXPECT_TRUE(source->head().is_paced);
  const Taken taken = taken_of(*source, 3000);
  ASSERT_FALSE(taken.error);
  EXPECT_EQ(taken.lost, 0U);
  const double step_v = 10.0 / 16384.0;
  expect_ramp(taken.channels[0], 0, step_v);
  for (std::size_t k = 0; k < 3000; ++k) {
    const double time_s = static_cast<double>(k) / recording.time.rate_hz + 1.0 / 48'000.0;
    ASSERT_NEAR(taken.channels[1][k], std::sin(2.0 * 2.0 * std::numbers::pi * time_s), step_v) << k;
  }
}

TEST(DaqmxSource, TellsWhatWasAskedAndWhatWasGranted) {
  const auto source = opened("Dev1/ai3:4?rate=1024&range=-3..3").value();
  const SourceHead& head = source->head();
  EXPECT_EQ(head.recording.time.rate_hz, 12e6 / 11718.0);
  EXPECT_EQ(setting(head, "device"), "USB-6009 (Dev1)");
  EXPECT_EQ(setting(head, "rate asked"), "1024 Hz");
  EXPECT_EQ(setting(head, "rate granted"), "1024.06554 Hz");
  EXPECT_EQ(setting(head, "range asked"), "±3 V");
  EXPECT_EQ(setting(head, "range granted"), "ai3 ±4 V, ai4 ±10 V");
  EXPECT_EQ(setting(head, "terminals asked"), "default");
  EXPECT_EQ(setting(head, "terminals granted"), "ai3 diff, ai4 rse");
  EXPECT_EQ(setting(head, "channel skew"), "20.83 us");
}

TEST(DaqmxSource, OfOneChannelHasNoSkew) {
  EXPECT_EQ(setting(opened("Dev1/ai0").value()->head(), "channel skew"), "");
}

TEST(DaqmxSource, RefusesInTheDriversWordsAndSaysWhatThereIs) {
  EXPECT_EQ(refusal("Dev1/ai0?range=-30..30&terminal=rse"),
            "daqmx:Dev1/ai0?range=-30..30&terminal=rse: Requested value is not a supported value. "
            "Property: AI.Max Requested value: 30 Channel: Dev1/ai0 Status Code: -200077 "
            "(NI-DAQmx -200077); Dev1 (USB-6009) has ai0, ai1, ai2, ai3, ai4, ai5, ai6, ai7 in "
            "the ranges ±1 V, ±1.25 V, ±2 V, ±2.5 V, ±4 V, ±5 V, ±10 V, ±20 V; see terminal= too");
  EXPECT_NE(refusal("Dev1/ai0:5?rate=10000").find("Dev1 takes 48000 samples a second at most"),
            std::string::npos);
  EXPECT_NE(refusal("Dev1/ai5?terminal=diff").find("AI.TermCfg"), std::string::npos);
  EXPECT_NE(refusal("Dev1/ai9").find("has ai0, ai1"), std::string::npos);
  EXPECT_NE(refusal("Dev7/ai0").find("there are Dev1, Dev2"), std::string::npos);
  EXPECT_NE(refusal("DevGone/ai0").find("-201003"), std::string::npos);
  EXPECT_NE(refusal("DevWild/ai0").find("granted a rate of nan Hz"), std::string::npos);
}

TEST(DaqmxSource, CountsTheRowsOfAnOverrunAndGoesOn) {
  for (const char* device : {"DevOverrun", "DevFifo"}) {
    const auto source = opened(fmt::format("{}/ai0?rate=2000&terminal=rse", device)).value();
    const Taken taken = taken_of(*source, 300);
    ASSERT_FALSE(taken.error);
    EXPECT_EQ(taken.rows_before_loss, 200U);
    EXPECT_GE(taken.lost, 50U);
    ASSERT_EQ(taken.notes.size(), 1U);
    EXPECT_EQ(taken.notes.front().severity, Severity::bad);
    EXPECT_NE(taken.notes.front().text.find("50 rows that the card took are lost"),
              std::string::npos);
    expect_ramp(taken.channels[0], 200, 20.0 / 8192.0);
  }
}

TEST(DaqmxSource, OfAnOldDriverCountsByTheHostsClockAndSaysSo) {
  const auto source =
      opened("DevOverrun/ai0:1?rate=2000&terminal=rse", PROOFMASS_NIDAQMX_STANDIN_OLD).value();
  EXPECT_EQ(setting(source->head(), "range granted"), "");
  EXPECT_EQ(setting(source->head(), "channel skew"), "");
  EXPECT_EQ(setting(source->head(), "terminals asked"), "rse");
  const Taken taken = taken_of(*source, 300);
  EXPECT_EQ(taken.rows_before_loss, 200U);
  EXPECT_GE(taken.lost, 1U);
  ASSERT_EQ(taken.notes.size(), 1U);
  EXPECT_NE(taken.notes.front().text.find("does not report"), std::string::npos);
  EXPECT_NE(taken.notes.front().text.find(fmt::format("clock {} rows are missing", taken.lost)),
            std::string::npos)
      << taken.notes.front().text;
}

TEST(DaqmxSource, OfAnOldDriverRefusesWithLessAdvice) {
  const auto range = opened("Dev1/ai0?range=-30..30", PROOFMASS_NIDAQMX_STANDIN_OLD);
  ASSERT_FALSE(range);
  EXPECT_TRUE(range.error().message.ends_with("ai6, ai7")) << range.error().message;
  const auto rate = opened("Dev1/ai0?rate=1e6", PROOFMASS_NIDAQMX_STANDIN_OLD);
  ASSERT_FALSE(rate);
  EXPECT_TRUE(rate.error().message.ends_with("request a lower rate=")) << rate.error().message;
}

TEST(DaqmxSource, GivesUpACardThatOnlyOverruns) {
  const Taken taken = taken_of(*opened("DevChoked/ai0").value(), 1);
  ASSERT_TRUE(taken.error);
  EXPECT_EQ(taken.error->code, Errc::device);
  EXPECT_NE(taken.error->message.find("10 times without success"), std::string::npos);
}

TEST(DaqmxSource, EndsWithAllRowsWhenTheCardIsPulled) {
  const Taken taken = taken_of(*opened("DevUnplug/ai0?rate=1000&terminal=rse").value(), 1000);
  ASSERT_TRUE(taken.error);
  EXPECT_EQ(taken.error->code, Errc::device);
  EXPECT_EQ(taken.error->message,
            "Device is not available. It was removed. Task Name: _unnamedTask<0> Status Code: "
            "-200045 (NI-DAQmx -200045)");
  EXPECT_EQ(taken.channels[0].size(), 205U);
  expect_ramp(taken.channels[0], 0, 20.0 / 8192.0);
}

TEST(DaqmxSource, WaitsForACardThatIsSilent) {
  const auto source = opened("DevTimeout/ai0").value();
  Arrival arrival;
  for (int again = 0; again < 3; ++again) {
    EXPECT_EQ(source->read(arrival, milliseconds(50)).value(), Arrived::nothing);
    EXPECT_EQ(arrival.rows(), 0U);
    EXPECT_TRUE(arrival.notes.empty());
  }
}

TEST(DaqmxSource, TakesWhatAReadingBringsBeforeItsTimeIsOver) {
  const auto source = opened("DevShort/ai0?rate=20000&terminal=rse").value();
  const Taken taken = taken_of(*source, 6000);
  ASSERT_FALSE(taken.error);
  EXPECT_EQ(taken.lost, 0U);
  expect_ramp(taken.channels[0], 0, 20.0 / 8192.0);
}

TEST(DaqmxSource, IsLeftEvenIfTheDriverNeverAnswers) {
  auto source = opened("DevHang/ai0").value();
  Arrival arrival;
  EXPECT_EQ(source->read(arrival, milliseconds(10)).value(), Arrived::nothing);
  source.reset();
}

TEST(DaqmxSource, NamesTheDevicesOfSeveral) {
  const auto source = opened("Dev1/ai0,Dev2/ai0").value();
  EXPECT_EQ(source->head().recording.channels[1].name, "Dev2/ai0");
}

TEST(DaqmxSource, WithoutTheDriverSaysWhatToInstall) {
  const auto absent = opened("Dev1/ai0", "/nowhere/libnidaqmx.so");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Errc::unsupported);
  EXPECT_NE(absent.error().message.find("NI-DAQmx is not installed: /nowhere/libnidaqmx.so"),
            std::string::npos);
  const auto other = opened("Dev1/ai0", "libm.so.6");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::unsupported);
  EXPECT_NE(other.error().message.find("its library has no DAQmxCreateTask"), std::string::npos);
  EXPECT_FALSE(find_daqmx("/nowhere/libnidaqmx.so"));
}

TEST(DaqmxSource, TakesTheLibraryOfItsUri) {
  EXPECT_TRUE(opened(fmt::format("Dev1/ai0?library={}", PROOFMASS_NIDAQMX_STANDIN),
                     "/nowhere/libnidaqmx.so"));
}

TEST(DaqmxSource, FindsTheCardsThatTheDriverLists) {
  const auto found = find_daqmx(PROOFMASS_NIDAQMX_STANDIN).value();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].uri, "daqmx:Dev1/ai0");
  EXPECT_EQ(found[0].what, "USB-6009, 8 analog inputs up to Dev1/ai7");
}

TEST(DaqmxSource, RefusesSettingsThatMakeNoSense) {
  for (const char* place :
       {"", "Dev1", "Dev1/ai0?rate=0", "Dev1/ai0?rate=x", "Dev1/ai0?range=5",
        "Dev1/ai0?range=5..-5", "Dev1/ai0?range=..", "Dev1/ai0?range=-inf..5",
        "Dev1/ai0?range=-5..5x", "Dev1/ai0?terminal=floating", "Dev1/ai0?rse=1"}) {
    const auto source = opened(place);
    ASSERT_FALSE(source) << place;
    EXPECT_EQ(source.error().code, Errc::invalid_argument) << place;
  }
}

}  // namespace
}  // namespace proofmass::acquire::daqmx_source_test
