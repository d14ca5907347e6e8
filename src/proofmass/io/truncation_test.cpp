// Every specimen of the fuzzers, truncated at every byte: each part is read or rejected with a
// one-line error, and never contains more than the whole.
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "proofmass/io/matlab/mat_specimens.hpp"
#include "proofmass/io/test_support.hpp"
#include "proofmass/io/ximu/specimens.hpp"

namespace proofmass::io::truncation_test {
namespace {

void break_off_everywhere(const std::string& folder, const std::vector<std::string>& magics) {
  std::size_t specimens = 0;
  const auto path = std::filesystem::path(PROOFMASS_SOURCE_DIR) / "fuzz/corpus" / folder;
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    ++specimens;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    for (const std::string& magic : magics) {
      for (std::size_t size = 0; size <= bytes.size(); ++size) {
        const auto read = read_text(magic + bytes.substr(0, size));
        if (read) {
          ASSERT_FALSE(read->channels.empty()) << entry.path() << " at " << size;
          for (const Channel& channel : read->channels)
            ASSERT_EQ(channel.values.size(), read->samples()) << entry.path() << " at " << size;
        } else {
          ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
          ASSERT_TRUE(read.error().message.starts_with("text: ")) << read.error().message;
        }
      }
    }
  }
  EXPECT_GT(specimens, 3u);
}

TEST(BrokenOff, CsvIsReadOrRefused) {
  break_off_everywhere("csv", {""});
}

TEST(BrokenOff, NpyIsReadOrRefused) {
  break_off_everywhere("npy", {"\x93NUMPY"});
}

TEST(BrokenOff, MatIsReadOrRefused) {
  break_off_everywhere("mat",
                       {specimen::mat5_header(), specimen::mat5_header(specimen::Order::big), ""});
}

TEST(BrokenOff, LvmIsReadOrRefused) {
  break_off_everywhere("lvm", {"LabVIEW Measurement"});
}

TEST(BrokenOff, WavIsReadOrRefused) {
  break_off_everywhere("wav", {"RIFFsizeWAVE", "RIFXsizeWAVE", "RF64sizeWAVE"});
}

TEST(BrokenOff, TdmsIsReadOrRefused) {
  break_off_everywhere("tdms", {"TDSm"});
}

TEST(BrokenOff, CompressedIsReadOrRefused) {
  break_off_everywhere("compressed",
                       {"\x1F\x8B\x08", std::string("\xFD\x37zXZ\0", 6), "\x28\xB5\x2F\xFD"});
}

TEST(BrokenOff, McapIsReadOrRefused) {
  break_off_everywhere("mcap", {"\x89MCAP0\r\n"});
}

TEST(BrokenOff, ZipIsReadOrRefused) {
  break_off_everywhere("zip", {"PK\x03\x04"});
}

TEST(BrokenOff, XimuIsReadOrRefused) {
  break_off_everywhere("ximu", {"", specimen::ximu_date_time(1)});
}

}  // namespace
}  // namespace proofmass::io::truncation_test
