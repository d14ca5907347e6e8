#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/characterise/noise_stream.hpp"

// A series analysed in parts whose sums are joined, against the same series at once.
namespace proofmass::characterise::noise_parts_test {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> walk_with_line(std::size_t n, unsigned seed = 31) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<double> y(n);
  double walk = 9.8;
  for (std::size_t k = 0; k < n; ++k)
    y[k] = normal(rng) + (walk += 0.003 * normal(rng)) + 0.2 * std::sin(0.7 * double(k));
  return y;
}

std::size_t origin_of(View<double> y) {
  return static_cast<std::size_t>(
      std::find_if(y.begin(), y.end(), [](double x) { return std::isfinite(x); }) - y.begin());
}

NoiseStream part_of(View<double> y,
                    const NoiseOptions& options,
                    std::size_t from,
                    std::size_t end) {
  NoiseStream part = NoiseStream::start_part(options, {from, origin_of(y), y.size()}).value();
  for (std::size_t size = 1; from < end; from += size, size = size * 7 % 4093 + 1)
    part.add(y.subspan(from, std::min(size, end - from)));
  return part;
}

std::string bytes_of(NoiseStream& part) {
  StateBytes bytes;
  part.exchange(bytes);
  return std::move(bytes).bytes();
}

// Written, and read as another process would.
NoiseStream through_bytes(NoiseStream part, const NoiseOptions& options, const PartPlace& place) {
  const std::string written = bytes_of(part);
  NoiseStream read = NoiseStream::start_part(options, place).value();
  StateBytes bytes(written);
  read.exchange(bytes);
  EXPECT_TRUE(bytes.complete()) << "part at " << place.first;
  return read;
}

std::vector<NoiseStream> parts_of(View<double> y,
                                  const NoiseOptions& options,
                                  const std::vector<std::size_t>& cuts) {
  std::vector<NoiseStream> parts;
  std::size_t from = 0;
  for (std::size_t k = 0; k <= cuts.size(); ++k) {
    const std::size_t end = k < cuts.size() ? cuts[k] : y.size();
    parts.push_back(
        through_bytes(part_of(y, options, from, end), options, {from, origin_of(y), y.size()}));
    from = end;
  }
  return parts;
}

NoiseStream from_the_left(std::vector<NoiseStream> parts) {
  NoiseStream all = std::move(parts.front());
  for (std::size_t k = 1; k < parts.size(); ++k) all.append(std::move(parts[k]));
  return all;
}

NoiseStream from_the_right(std::vector<NoiseStream> parts) {
  while (parts.size() > 1) {
    NoiseStream last = std::move(parts.back());
    parts.pop_back();
    parts.back().append(std::move(last));
  }
  return std::move(parts.front());
}

// Neighbours in pairs, and those in pairs: as a tree of machines would.
NoiseStream as_a_tree(std::vector<NoiseStream> parts) {
  while (parts.size() > 1) {
    std::vector<NoiseStream> pairs;
    for (std::size_t k = 0; k < parts.size(); k += 2) {
      pairs.push_back(std::move(parts[k]));
      if (k + 1 < parts.size()) pairs.back().append(std::move(parts[k + 1]));
    }
    parts = std::move(pairs);
  }
  return std::move(parts.front());
}

void expect_same(const NoiseAnalysis& found, const NoiseAnalysis& whole) {
  EXPECT_EQ(found.samples, whole.samples);
  EXPECT_EQ(found.missing, whole.missing);
  EXPECT_NEAR(found.mean / whole.mean, 1.0, 1e-13);
  ASSERT_EQ(found.deviation.points.size(), whole.deviation.points.size());
  for (std::size_t k = 0; k < whole.deviation.points.size(); ++k) {
    const DeviationPoint &a = found.deviation.points[k], &b = whole.deviation.points[k];
    SCOPED_TRACE(b.m);
    EXPECT_EQ(a.m, b.m);
    EXPECT_EQ(a.terms, b.terms);
    EXPECT_EQ(a.alpha, b.alpha);
    EXPECT_NEAR(a.value / b.value, 1.0, 1e-12);
    EXPECT_NEAR(a.edf / b.edf, 1.0, 1e-6);
  }
  ASSERT_EQ(found.spectrum.one_sided_psd.size(), whole.spectrum.one_sided_psd.size());
  EXPECT_EQ(found.spectrum.averaged, whole.spectrum.averaged);
  for (std::size_t k = 0; k < whole.spectrum.one_sided_psd.size(); ++k)
    EXPECT_NEAR(found.spectrum.one_sided_psd[k] / whole.spectrum.one_sided_psd[k], 1.0, 1e-11);
  EXPECT_EQ(found.lines.lines.size(), whole.lines.lines.size());
  EXPECT_NEAR(found.model.white.value / whole.model.white.value, 1.0, 1e-9);
  EXPECT_NEAR(found.model.random_walk.value / whole.model.random_walk.value, 1.0, 1e-6);
  EXPECT_NEAR(found.model.random_walk.upper_95 / whole.model.random_walk.upper_95, 1.0, 1e-6);
  EXPECT_EQ(found.stationarity.stationary, whole.stationarity.stationary);
  EXPECT_NEAR(found.stationarity.p / whole.stationarity.p, 1.0, 1e-9);
  ASSERT_EQ(found.notes.size(), whole.notes.size());
  for (std::size_t k = 0; k < whole.notes.size(); ++k)
    EXPECT_EQ(found.notes[k].text, whole.notes[k].text);
}

void expect_parts_are_the_whole(const std::vector<double>& y,
                                const NoiseOptions& options,
                                const std::vector<std::size_t>& cuts) {
  NoiseStream whole = NoiseStream::start(options, y.size()).value();
  whole.add(y);
  const NoiseAnalysis at_once = whole.finish().value();
  for (const auto& join : {from_the_left, from_the_right, as_a_tree}) {
    NoiseStream joined = join(parts_of(y, options, cuts));
    expect_same(joined.finish().value(), at_once);
  }
}

constexpr std::size_t long_record = (std::size_t{1} << 20) + 54'321;

std::vector<std::size_t> hours(std::size_t n) {
  std::vector<std::size_t> cuts;
  for (std::size_t k = 1; k < 24; ++k) cuts.push_back(k * n / 24);
  return cuts;
}

TEST(NoiseParts, TwentyFourHoursAreTheDay) {
  const auto y = walk_with_line(long_record);
  for (const Statistic statistic : {Statistic::oadev, Statistic::ohdev}) {
    SCOPED_TRACE(name_of(statistic));
    expect_parts_are_the_whole(y, {.rate_hz = 100.0, .statistic = statistic}, hours(y.size()));
  }
}

TEST(NoiseParts, GapsBetweenTheFilesAndWithinThemAreThoseOfTheDay) {
  auto y = walk_with_line(long_record);
  const auto drop = [&](std::size_t from, std::size_t end) {
    std::fill(y.begin() + std::ptrdiff_t(from), y.begin() + std::ptrdiff_t(end), missing);
  };
  const auto cuts = hours(y.size());
  drop(0, 77);                      // before the first valid sample
  drop(cuts[3] - 10, cuts[3] + 5);  // across a border
  drop(cuts[6], cuts[6] + 1);       // at the start of a part
  drop(cuts[9] - 3000, cuts[9]);    // to its end
  drop(cuts[11], cuts[12]);         // a whole file
  for (std::size_t k = 1000; k < y.size(); k += 40'000) drop(k, k + 3);
  drop(y.size() - 9, y.size());
  expect_parts_are_the_whole(y, {.rate_hz = 100.0}, cuts);
}

TEST(NoiseParts, AreTheWholeWhereverItIsCut) {
  const auto y = walk_with_line(long_record);
  // Parts shorter than any block, segment or term; and of very unequal length.
  std::vector<std::size_t> cuts{1, 2, 3, 66, 67, 130, 2047, 2048, 2049, 4096, 8191, 8200, 9000};
  for (std::size_t cut = 9001; cut < y.size(); cut = cut * 3 / 2) cuts.push_back(cut);
  expect_parts_are_the_whole(y, {.rate_hz = 100.0}, cuts);
}

TEST(NoiseParts, OfOneSampleOrNoneValidAreTheWhole) {
  auto y = walk_with_line(long_record);
  std::vector<std::size_t> cuts;
  for (std::size_t k = 0; k < 40; ++k) cuts.push_back(1 + k);
  std::fill(y.begin(), y.begin() + 20, missing);
  expect_parts_are_the_whole(y, {.rate_hz = 100.0}, cuts);
}

TEST(NoiseParts, TheModifiedDeviationsAreTheWhole) {
  const auto y = walk_with_line(long_record);
  NoiseStream whole =
      NoiseStream::start({.rate_hz = 100.0, .statistic = Statistic::mdev}, y.size()).value();
  whole.add(y);
  const NoiseAnalysis at_once = whole.finish().value();
  NoiseStream joined =
      from_the_left(parts_of(y, {.rate_hz = 100.0, .statistic = Statistic::mdev}, hours(y.size())));
  const NoiseAnalysis found = joined.finish().value();
  ASSERT_EQ(found.deviation.points.size(), at_once.deviation.points.size());
  for (std::size_t k = 0; k < found.deviation.points.size(); ++k)
    EXPECT_NEAR(found.deviation.points[k].value / at_once.deviation.points[k].value, 1.0, 1e-9)
        << found.deviation.points[k].m;
}

// A warm-up of a thousand times the noise, in which the two integrals of neighbours differ much.
TEST(NoiseParts, KeepTheirDigitsInAStrongDrift) {
  auto y = walk_with_line(long_record);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += 1000.0 * std::exp(-double(k) / 1e5);
  NoiseStream whole = NoiseStream::start({.rate_hz = 100.0}, y.size()).value();
  whole.add(y);
  const NoiseAnalysis at_once = whole.finish().value();
  NoiseStream joined = from_the_left(parts_of(y, {.rate_hz = 100.0}, hours(y.size())));
  const NoiseAnalysis found = joined.finish().value();
  ASSERT_EQ(found.deviation.points.size(), at_once.deviation.points.size());
  for (std::size_t k = 0; k < found.deviation.points.size(); ++k)
    EXPECT_NEAR(found.deviation.points[k].value / at_once.deviation.points[k].value, 1.0, 1e-11)
        << found.deviation.points[k].m;
}

TEST(NoiseParts, ReportChangesOfTheNoiseAndClippingAsTheWhole) {
  auto y = walk_with_line(long_record);
  for (std::size_t k = y.size() / 2; k < y.size(); ++k) y[k] += 0.3 * (y[k] - 9.8);
  NoiseStream changing = from_the_left(parts_of(y, {.rate_hz = 100.0}, hours(y.size())));
  EXPECT_FALSE(changing.finish().value().stationarity.stationary);
  for (double& x : y) x = std::min(x, 10.5);
  NoiseStream clipped = from_the_left(parts_of(y, {.rate_hz = 100.0}, hours(y.size())));
  NoiseStream whole = NoiseStream::start({.rate_hz = 100.0}, y.size()).value();
  whole.add(y);
  const auto found = clipped.finish(), at_once = whole.finish();
  ASSERT_FALSE(found);
  ASSERT_FALSE(at_once);
  EXPECT_EQ(found.error().message, at_once.error().message);
}

TEST(NoiseParts, AnHourAtAKilohertzHasLessThanAMegabyte) {
  const std::size_t hour = 3'600'000;
  const auto y = walk_with_line(hour);
  const NoiseOptions options{.rate_hz = 1000.0};
  for (const std::size_t before : {std::size_t{0}, 5 * hour}) {
    NoiseStream part = NoiseStream::start_part(options, {before, 0, 24 * hour}).value();
    part.add(y);
    const std::size_t bytes = bytes_of(part).size();
    EXPECT_LT(bytes, before == 0 ? 2'000'000U : 1'000'000U);
    std::printf("an hour at 1 kHz, %zu samples before it: %zu bytes\n", before, bytes);
  }
}

TEST(NoiseParts, WhateverIsCutOffTheStateIsRefused) {
  const NoiseOptions options{.rate_hz = 100.0};
  const PartPlace place{5'000, 3, 2'000'000};
  NoiseStream part = NoiseStream::start_part(options, place).value();
  part.add(walk_with_line(300));
  const std::string written = bytes_of(part);
  for (std::size_t length = 0; length < written.size(); length += length < 2000 ? 1 : 97) {
    NoiseStream read = NoiseStream::start_part(options, place).value();
    StateBytes bytes(std::string_view(written).substr(0, length));
    read.exchange(bytes);
    EXPECT_FALSE(bytes.complete()) << length;
  }
  // At another place than that it was made for.
  NoiseStream other = NoiseStream::start_part(options, {5'001, 3, 2'000'000}).value();
  StateBytes bytes(written);
  other.exchange(bytes);
  EXPECT_FALSE(bytes.complete());
}

// Nothing that passes the checks may end the process when it is joined.
TEST(NoiseParts, AnyChangedByteIsRefusedOrHarmless) {
  const NoiseOptions options{.rate_hz = 100.0};
  const PartPlace place{5'000, 0, 2'000'000};
  const auto y = walk_with_line(5'300);
  NoiseStream before = NoiseStream::start_part(options, {0, 0, 2'000'000}).value();
  before.add(View<double>(y).first(5'000));
  NoiseStream part = NoiseStream::start_part(options, place).value();
  part.add(View<double>(y).subspan(5'000));
  const std::string written = bytes_of(part), of_before = bytes_of(before);
  std::mt19937_64 rng(5);
  for (int k = 0; k < 300; ++k) {
    std::string changed = written;
    const std::size_t at = k < 150 ? rng() % 400 : rng() % changed.size();
    changed[at] = static_cast<char>(rng());
    NoiseStream read = NoiseStream::start_part(options, place).value();
    StateBytes bytes(changed);
    read.exchange(bytes);
    if (!bytes.complete()) continue;
    NoiseStream whole = NoiseStream::start_part(options, {0, 0, 2'000'000}).value();
    StateBytes first(of_before);
    whole.exchange(first);
    ASSERT_TRUE(first.complete());
    whole.append(std::move(read));
    [[maybe_unused]] const auto found = whole.finish();
  }
}

}  // namespace
}  // namespace proofmass::characterise::noise_parts_test
