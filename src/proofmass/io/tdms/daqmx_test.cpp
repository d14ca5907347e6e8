#include <gtest/gtest.h>

#include "proofmass/io/tdms/tdms_test_support.hpp"

namespace proofmass::io::tdms::daqmx_test {
namespace {

using namespace specimen;
TEST(TdmsDaqmx, DaqmxScalersLieInTheRowsOfTheirBuffers) {
  TdmsList list;
  list.daqmx("/'g'/'a'", 3, {list.scaler(3, 0, 0, 0)}, {6, 4});
  list.daqmx("/'g'/'b'", 3, {list.scaler(5, 0, 2, 0)}, {6, 4});
  list.daqmx("/'g'/'c'", 3, {list.scaler(2, 1, 2, 0)}, {6, 4});
  std::string data;
  for (int i = 0; i < 3; ++i)
    data += bytes_of<std::int16_t>({static_cast<std::int16_t>(-i)}) +
            bytes_of<std::int32_t>({100000 + i});
  for (int i = 0; i < 3; ++i)
    data += bytes_of<std::uint16_t>({7, static_cast<std::uint16_t>(65000 + i)});
  const auto read = tdms_or_fail(tdms_segment(tdms_whole | tdms_daqmx, list.bytes(), data + data));
  EXPECT_EQ(read.columns, (Columns{{0, -1, -2, 0, -1, -2},
                                   {100000, 100001, 100002, 100000, 100001, 100002},
                                   {65000, 65001, 65002, 65000, 65001, 65002}}));
}

TEST(TdmsDaqmx, DaqmxBuffersMayBeOfDifferentLength) {
  TdmsList list;
  list.daqmx("/'g'/'a'", 4, {list.scaler(3, 0, 0, 0)}, {2, 2});
  list.daqmx("/'g'/'b'", 2, {list.scaler(3, 1, 0, 0)}, {2, 2});
  const auto data = bytes_of<std::int16_t>({1, 2, 3, 4, 11, 12, 5, 6, 7, 8, 13, 14});
  const std::string file = tdms_segment(tdms_whole | tdms_daqmx, list.bytes(), data);
  EXPECT_EQ(tdms_or_fail(file, 0).columns, (Columns{{1, 2, 3, 4, 5, 6, 7, 8}}));
  EXPECT_EQ(tdms_or_fail(file, 1).columns, (Columns{{11, 12, 13, 14}}));
}

TEST(TdmsDaqmx, DigitalLinesAreBitsOfTheRow) {
  TdmsList list;
  for (std::uint32_t line = 0; line < 3; ++line)
    list.daqmx("/'g'/'" + std::to_string(line) + "'", 4, {list.digital_line(0, 16 + line)}, {4},
               0x126A);
  std::string data;
  for (const char byte : {'\0', '\1', '\6', '\7'}) data += std::string(2, '\x55') + byte + '\x7F';
  const auto read = tdms_or_fail(tdms_segment(tdms_whole | tdms_daqmx, list.bytes(), data));
  EXPECT_EQ(read.columns, (Columns{{0, 1, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, 1}}));
}

TEST(TdmsDaqmx, AChannelOfRawDataMayTakeSeveralScalers) {
  TdmsList list;
  list.daqmx("/'g'/'a'", 2, {list.scaler(3, 0, 0, 0), list.scaler(3, 0, 2, 2)}, {4});
  list.property("NI_Number_Of_Scales", 5U)
      .property("NI_Scale[1]_Scale_Type", "Linear")
      .property("NI_Scale[1]_Linear_Slope", 10.0)
      .property("NI_Scale[1]_Linear_Y_Intercept", 0.5)
      .property("NI_Scale[1]_Linear_Input_Source", 0U)
      .property("NI_Scale[4]_Scale_Type", "Subtract")
      .property("NI_Scale[4]_Subtract_Left_Operand_Input_Source", 1U)
      .property("NI_Scale[4]_Subtract_Right_Operand_Input_Source", 2U);
  const auto read = tdms_or_fail(tdms_segment(tdms_whole | tdms_daqmx, list.bytes(),
                                              bytes_of<std::int16_t>({1, 100, 2, 200})));
  EXPECT_EQ(read.columns, (Columns{{100 - 10.5, 200 - 20.5}}));
  EXPECT_TRUE(read.is_noted("a: scaled as the file says: linear 10 x + 0.5, then difference"))
      << read.all_notes();
}

}  // namespace
}  // namespace proofmass::io::tdms::daqmx_test
