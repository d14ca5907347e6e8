#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"
#include "proofmass/io/wav/specimens.hpp"

namespace proofmass::io::wav::wav_test {
namespace {

using namespace specimen;
using Values = std::vector<double>;

Values first_channel(const std::string& file) {
  const auto read = read_text(file);
  EXPECT_TRUE(read.has_value()) << read.error().message;
  return read ? read->channels.at(0).values.copy() : Values{};
}

Errc code_of(const std::string& file) {
  const auto read = read_text(file);
  EXPECT_FALSE(read.has_value());
  return read ? Errc::invalid_argument : read.error().code;
}

/// Rows of three accelerations and a status word of the instrument.
const std::string comment =
    "Time: 2014-08-01 10:00:00.500\nChannel-1: Accel-X\nScale-1: 8\nChannel-2: Accel-Y\n"
    "Scale-2: 8\nChannel-3: Accel-Z\nScale-3: 8\nChannel-4: Aux\n";
std::string export_of_axivity(const std::string& texts) {
  return riff(format_chunk({1, 4, 100, 16}) + chunk("LIST", "INFO" + texts) +
              chunk("data", bytes_of<std::int16_t>(
                                {0, 4096, -4096, 0, 4096, 0, 0, -32768, 4096, 0, -4096, 1024})));
}

TEST(Wav, ReadsEveryKindOfSample) {
  const Values values{-2.0, 0.0, 96.0};
  EXPECT_EQ(first_channel(wav_file({1, 1, 100, 16}, bytes_of<std::int16_t>({-2, 0, 96}))), values);
  EXPECT_EQ(first_channel(wav_file({1, 1, 100, 32}, bytes_of<std::int32_t>({-2, 0, 96}))), values);
  EXPECT_EQ(first_channel(wav_file({3, 1, 100, 32}, bytes_of<float>({-2, 0, 96}))), values);
  EXPECT_EQ(first_channel(wav_file({3, 1, 100, 64}, bytes_of<double>({-2, 0, 96}))), values);
  EXPECT_EQ(first_channel(wav_file({1, 1, 100, 24}, std::string("\xFE\xFF\xFF\0\0\0\x60\0\0", 9))),
            values);
  EXPECT_EQ(first_channel(wav_file({1, 1, 100, 8}, "\x7E\x80\xE0")), (Values{126, 128, 224}));
}

TEST(Wav, ReadsBigEndianFiles) {
  EXPECT_EQ(first_channel(wav_file({1, 1, 100, 16, Order::big},
                                   bytes_of<std::int16_t>({-2, 513}, Order::big))),
            (Values{-2, 513}));
  EXPECT_EQ(first_channel(
                wav_file({1, 1, 100, 24, Order::big}, std::string("\xFF\xFF\xFE\0\x02\x01", 6))),
            (Values{-2, 513}));
}

TEST(Wav, KeepsChannelsApartAtTheRateOfTheFile) {
  const auto read =
      read_text(wav_file({1, 3, 400, 16}, bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6})));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "WAV");
  EXPECT_EQ(read->time.rate_hz, 400.0);
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[1].name, "channel_2");
  EXPECT_EQ(read->channels[1].unit.quantity, Quantity::counts);
  EXPECT_EQ(read->channels[1].values, (Values{2, 5}));
  EXPECT_TRUE(is_noted(*read, "full scale is ±32768"));
}

TEST(Wav, ReadsTheLongFormOfTheHeader) {
  const auto read = read_text(riff(extensible_chunk({1, 1, 50, 32}, 24) +
                                   chunk("data", bytes_of<std::int32_t>({-256, 512}))));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, (Values{-256, 512}));
  EXPECT_TRUE(is_noted(*read, "the topmost 24 bits"));
}

TEST(Wav, PassesOverChunksOfAnyLength) {
  const std::string odd = chunk("junk", "abc");
  EXPECT_EQ(first_channel(riff(odd + format_chunk({}) + odd +
                               chunk("data", bytes_of<std::int16_t>({7, 8})) + odd)),
            (Values{7, 8}));
}

TEST(Wav, ReadsLengthsOfMoreThan32Bits) {
  for (const char* form : {"RF64", "BW64"}) {
    const std::string file =
        form + std::string("\xFF\xFF\xFF\xFF", 4) + "WAVE" +
        chunk("ds64", bytes_of<std::uint64_t>({100, 4, 2}) + std::string(4, '\0')) +
        format_chunk({}) +
        chunk("data", bytes_of<std::int16_t>({7, 8}), Order::little, 0xFFFFFFFF) +
        chunk("LIST", "INFO" + chunk("INAM", "title"));
    const auto read = read_text(file);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->channels[0].values, (Values{7, 8}));
    EXPECT_TRUE(is_noted(*read, "INAM \"title\""));
  }
}

TEST(Wav, ReadsToTheEndWhereTheRecorderWasKilled) {
  const std::string samples = bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6});
  for (const std::int64_t claimed : {std::int64_t{0}, std::int64_t{0xFFFFFFFF}}) {
    const auto read =
        read_text(riff(format_chunk({}) + chunk("data", samples, Order::little, claimed)));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->samples(), 6u);
    EXPECT_TRUE(is_noted(*read, "never filled in"));
  }
}

TEST(Wav, TellsWhereItBreaksOff) {
  const std::string whole = wav_file({1, 2, 100, 16}, bytes_of<std::int16_t>({1, 2, 3, 4, 5, 6}));
  const auto read = read_text(whole.substr(0, whole.size() - 1));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 2u);
  EXPECT_TRUE(is_noted(*read, "breaks off after 2 of 3 samples")) << notes_of(*read);
}

TEST(Wav, TakesTheScaleThatAnAxivityExportTells) {
  const auto read = read_text(export_of_axivity(chunk("ICMT", comment)));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 4u);
  EXPECT_EQ(read->channels[0].name, "Accel-X");
  EXPECT_EQ(read->channels[0].unit.symbol, "g");
  EXPECT_EQ(read->channels[0].values[0], 0.0);
  EXPECT_EQ(read->channels[1].values[0], 1.0);
  EXPECT_EQ(read->channels[2].values[2], -1.0);
  EXPECT_EQ(read->channels[3].values[2], 1024.0);
  // 2014-08-01 10:00:00.5 UTC
  EXPECT_EQ(read->time.start_ns, 1'406'887'200'500'000'000);
}

TEST(Wav, MarksSamplesThatTheInstrumentLost) {
  const auto read = read_text(export_of_axivity(chunk("ICMT", comment)));
  ASSERT_TRUE(read.has_value());
  EXPECT_TRUE(std::isnan(read->channels[0].values[1]));
  EXPECT_EQ(read->channels[3].values[1], -32768.0);
  EXPECT_TRUE(is_noted(*read, "1 samples are marked as lost"));
}

TEST(Wav, BelievesNoLengthBeyondTheFile) {
  EXPECT_EQ(code_of(riff(format_chunk({1, 30'000, 100, 16}) + chunk("data", "abcd"))),
            Errc::too_few_samples);
  EXPECT_EQ(code_of(riff(chunk("fmt ", "ab", Order::little, 0x7FFFFFFF))), Errc::corrupt);
  EXPECT_EQ(first_channel(riff(format_chunk({}) + chunk("data", bytes_of<std::int16_t>({3, 4}),
                                                        Order::little, 0x7FFFFFF0))),
            (Values{3, 4}));
}

TEST(Wav, RefusesWhatItDoesNotRead) {
  EXPECT_EQ(code_of(wav_file({2, 1, 100, 4}, "abcd")), Errc::unsupported);
  EXPECT_EQ(code_of(wav_file({7, 1, 100, 8}, "abcd")), Errc::unsupported);
  EXPECT_EQ(code_of(wav_file({1, 1, 100, 40}, "abcdefghij")), Errc::unsupported);
  EXPECT_EQ(code_of(wav_file({3, 1, 100, 16}, "abcd")), Errc::unsupported);
  EXPECT_EQ(code_of(wav_file({1, 0, 100, 16}, "abcd")), Errc::corrupt);
  EXPECT_EQ(code_of(riff(chunk("data", "abcd"))), Errc::corrupt);
  EXPECT_EQ(code_of(riff(format_chunk({}))), Errc::corrupt);
  EXPECT_EQ(code_of(riff(format_chunk({}) + chunk("data", ""))), Errc::too_few_samples);
}

}  // namespace
}  // namespace proofmass::io::wav::wav_test
