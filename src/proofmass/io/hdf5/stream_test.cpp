#include "proofmass/io/hdf5/stream.hpp"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/io/bytes/subprocess_frames.hpp"

namespace proofmass::io::hdf5::stream_test {
namespace {

std::string frame(FrameKind kind, std::string_view bytes = {}) {
  const FrameHeader header{kind, static_cast<std::uint32_t>(bytes.size())};
  std::string out(sizeof header, '\0');
  std::memcpy(out.data(), &header, sizeof header);
  return out + std::string(bytes);
}

template <class T>
std::string data(const std::vector<T>& figures) {
  return frame(FrameKind::data,
               {reinterpret_cast<const char*>(figures.data()), figures.size() * sizeof(T)});
}

FigureStream stream_of(std::string said) {
  std::vector<Request> requests{{.name = "a", .rows = 2, .width = 2},
                                {.name = "t", .rows = 2, .width = 1, .figures = Figures::int64}};
  return {std::move(requests),
          [said = std::move(said),
           at = std::size_t{0}](std::span<char> into) mutable -> Result<std::size_t> {
            const std::size_t count = said.copy(into.data(), into.size(), at);
            at += count;
            return count;
          }};
}

const std::int64_t epoch = 1'700'000'000'000'000'001;
const std::string columns = data(std::vector<double>{1.0, 2.0, 3.0, 4.0});
const std::string stamps = data(std::vector<std::int64_t>{epoch, epoch + 3});

TEST(FigureStream, TakesBlocksAsTheyAreSaid) {
  FigureStream stream = stream_of(columns + stamps + frame(FrameKind::end));
  const auto rows = stream.next();
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(*rows, 2u);
  EXPECT_TRUE(stream.put_origin_at_first(1) == epoch);
  std::vector<double> column(2);
  stream.copy(0, 1, 0, column);
  EXPECT_EQ(column, (std::vector<double>{3.0, 4.0}));
  stream.copy(1, 0, 0, column);
  EXPECT_EQ(column, (std::vector<double>{0.0, 3.0}));
  const auto end = stream.next();
  ASSERT_TRUE(end);
  EXPECT_EQ(*end, 0u);
  EXPECT_EQ(stream.fraction_read(), 1.0);
}

TEST(FigureStream, RefusesWhatBreaksOffOrHasAnotherSize) {
  const std::string whole = columns + stamps;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    FigureStream stream = stream_of(whole.substr(0, size));
    const auto rows = stream.next();
    ASSERT_FALSE(rows) << size;
    EXPECT_EQ(rows.error().code, Errc::corrupt);
  }
  for (const std::string& said : {stamps + columns, columns + columns,
                                  columns + frame(FrameKind::end), frame(FrameKind::data)}) {
    FigureStream stream = stream_of(said);
    EXPECT_FALSE(stream.next());
  }
}

}  // namespace
}  // namespace proofmass::io::hdf5::stream_test
