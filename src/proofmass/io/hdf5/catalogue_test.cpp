#include "proofmass/io/hdf5/catalogue.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace proofmass::io::hdf5::catalogue_test {
namespace {

Catalogue example() {
  Catalogue catalogue;
  catalogue.datasets.push_back({.path = "imu/acc",
                                .address = "/imu/acc",
                                .type = "float64",
                                .shape = {500, 3},
                                .group_length = 3});
  catalogue.datasets.push_back({.path = "fs", .address = "/fs", .type = "int32", .figure = 100.0});
  catalogue.attributes.push_back(
      {.owner = "imu/acc", .name = "units", .texts = {"m/s²", "", "g"}, .figure = std::nullopt});
  catalogue.skipped = {"title (text)"};
  catalogue.is_cut = true;
  return catalogue;
}

TEST(Catalogue, ComesBackAsItWas) {
  const auto read = decode(encode(example()));
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->datasets.size(), 2u);
  EXPECT_EQ(read->datasets[0].path, "imu/acc");
  EXPECT_EQ(read->datasets[0].address, "/imu/acc");
  EXPECT_EQ(read->datasets[0].shape, (std::vector<std::uint64_t>{500, 3}));
  EXPECT_EQ(read->datasets[0].group_length, 3u);
  EXPECT_EQ(read->datasets[0].figure, std::nullopt);
  EXPECT_EQ(read->datasets[1].figure, 100.0);
  EXPECT_EQ(read->attributes[0].texts, (std::vector<std::string>{"m/s²", "", "g"}));
  EXPECT_EQ(read->skipped[0], "title (text)");
  EXPECT_TRUE(read->is_cut);
}

TEST(Catalogue, IsRefusedWhereverItBreaksOffOrGoesOn) {
  const std::string whole = encode(example());
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode(std::string_view(whole).substr(0, size))) << size;
  EXPECT_FALSE(decode(whole + '\0'));
}

TEST(Catalogue, BelievesNoLength) {
  const std::string whole = encode(example());
  for (std::size_t byte = 0; byte < whole.size(); ++byte)
    for (const char value : {'\x01', '\x7F', '\xFF'}) {
      std::string changed = whole;
      changed[byte] = value;
      const auto read = decode(changed);
      if (!read) continue;
      for (const Dataset& dataset : read->datasets)
        EXPECT_LT(dataset.group_length, dataset.path.size());
    }
  Catalogue impossible = example();
  impossible.datasets[0].shape = {std::uint64_t{1} << 40, std::uint64_t{1} << 40};
  EXPECT_FALSE(decode(encode(impossible)));
}

TEST(Catalogue, HasTextsOfOneLine) {
  Catalogue catalogue = example();
  catalogue.attributes[0].texts = {"two\nlines\x1b[31m"};
  const auto read = decode(encode(catalogue));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->attributes[0].texts[0], "two lines [31m");
}

}  // namespace
}  // namespace proofmass::io::hdf5::catalogue_test
