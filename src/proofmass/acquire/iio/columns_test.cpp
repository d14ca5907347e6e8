#include "proofmass/acquire/iio/columns.hpp"

#include <gtest/gtest.h>

#include "proofmass/acquire/iio/handle.hpp"
#include "proofmass/acquire/iio/timing.hpp"

namespace proofmass::acquire::iio_columns_test {
namespace {

constexpr const char* head = R"(<?xml version="1.0" encoding="utf-8"?><!DOCTYPE context [
<!ELEMENT context (device | context-attribute)*><!ELEMENT context-attribute EMPTY>
<!ELEMENT device (channel | attribute)*><!ELEMENT channel (scan-element?, attribute*)>
<!ELEMENT attribute EMPTY><!ELEMENT scan-element EMPTY>
<!ATTLIST context name CDATA #REQUIRED description CDATA #IMPLIED>
<!ATTLIST context-attribute name CDATA #REQUIRED value CDATA #REQUIRED>
<!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED>
<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED name CDATA #IMPLIED>
<!ATTLIST scan-element index CDATA #REQUIRED format CDATA #REQUIRED scale CDATA #IMPLIED>
<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>]>
<context name="xml" description="none">)";

std::string device(const std::string& id, const std::string& name, const std::string& channels) {
  return "<device id=\"" + id + "\" name=\"" + name + "\">" + channels + "</device>";
}

std::string element(const std::string& id, int index, const std::string& format) {
  return "<channel id=\"" + id + "\" type=\"input\"><scan-element index=\"" +
         std::to_string(index) + "\" format=\"" + format + "\"/></channel>";
}

IioContext context_of(const std::string& devices) {
  const std::string text = head + devices + "</context>";
  return IioContext(iio_create_xml_context_mem(text.c_str(), text.size()));
}

const std::string accelerometer = element("accel_x", 0, "le:s12/16&gt;&gt;4") +
                                  element("accel_y", 1, "le:s12/16&gt;&gt;4") +
                                  element("timestamp", 2, "le:s64/64&gt;&gt;0");

TEST(IioDevice, IsTheOnlyOneThatMeasuresAcceleration) {
  const auto context =
      context_of(device("iio:device0", "adc", element("voltage0", 0, "le:u16/16&gt;&gt;0")) +
                 device("iio:device1", "lis3dh", accelerometer));
  EXPECT_EQ(iio_name(choose_device(context.get(), "").value()), "lis3dh");
  EXPECT_EQ(iio_name(choose_device(context.get(), "adc").value()), "adc");
  EXPECT_EQ(iio_name(choose_device(context.get(), "iio:device0").value()), "adc");
}

TEST(IioDevice, IsAskedForWhereThereAreSeveralOrNone) {
  const auto several = context_of(device("iio:device0", "lis3dh", accelerometer) +
                                  device("iio:device1", "kxcjk1013", accelerometer));
  const auto chosen = choose_device(several.get(), "");
  ASSERT_FALSE(chosen);
  EXPECT_EQ(chosen.error().message,
            "several devices measure acceleration: lis3dh (iio:device0), kxcjk1013 (iio:device1); "
            "name one with device=NAME");
  const auto none =
      context_of(device("iio:device0", "adc", element("voltage0", 0, "le:u16/16&gt;&gt;0")));
  EXPECT_EQ(choose_device(none.get(), "").error().code, Errc::invalid_argument);
  EXPECT_EQ(choose_device(none.get(), "bno055").error().message,
            "device=bno055: no such device; there are: adc (iio:device0)");
}

TEST(IioColumns, AreTheNamedScanElementsAndTheTimestamp) {
  const auto context = context_of(device("iio:device1", "lis3dh", accelerometer));
  iio_device* const lis3dh = choose_device(context.get(), "").value();
  EXPECT_EQ(choose_columns(lis3dh, {}).value().heads.size(), 2U);
  const IioColumns columns = choose_columns(lis3dh, {"accel_y"}).value();
  ASSERT_EQ(columns.heads.size(), 1U);
  EXPECT_EQ(columns.heads[0].name, "accel_y");
  EXPECT_NE(columns.stamp, nullptr);
  EXPECT_EQ(choose_columns(lis3dh, {"accel_w"}).error().message,
            "channels=accel_w: lis3dh has accel_x, accel_y");
}

TEST(IioColumns, WithoutAScaleAreCounts) {
  const auto context = context_of(device("iio:device1", "lis3dh", accelerometer));
  const IioColumns columns = choose_columns(choose_device(context.get(), "").value(), {}).value();
  EXPECT_EQ(columns.heads[0].unit.quantity, Quantity::counts);
}

TEST(IioColumns, OfAQuaternionAreFour) {
  const auto context = context_of(
      device("iio:device0", "fusion", element("rot_quaternion", 0, "le:s32/32X4&gt;&gt;0")));
  const IioColumns columns =
      choose_columns(choose_device(context.get(), "fusion").value(), {}).value();
  ASSERT_EQ(columns.heads.size(), 4U);
  EXPECT_EQ(columns.heads[3].name, "rot_quaternion_3");
  EXPECT_EQ(columns.stamp, nullptr);
}

TEST(IioColumns, RefuseALayoutThatIsNotRead) {
  for (const char* const format : {"le:s24/24&gt;&gt;0", "le:s64/64X200&gt;&gt;0"}) {
    const auto context = context_of(device("iio:device0", "odd", element("accel_x", 0, format)));
    EXPECT_EQ(choose_columns(choose_device(context.get(), "odd").value(), {}).error().code,
              Errc::unsupported)
        << format;
  }
}

TEST(IioColumns, OfADeviceWithoutABufferCannotBeRecorded) {
  const auto context =
      context_of(device("iio:device0", "slow", "<channel id=\"accel_x\" type=\"input\"/>"));
  const auto columns = choose_columns(choose_device(context.get(), "slow").value(), {});
  ASSERT_FALSE(columns);
  EXPECT_EQ(columns.error().code, Errc::device);
  EXPECT_NE(columns.error().message.find("slow has no buffer"), std::string::npos);
}

TEST(IioTiming, ListsTheTriggersThatThereAre) {
  const auto context = context_of(device("iio:device1", "lis3dh", accelerometer) +
                                  device("trigger0", "t0", "") + device("trigger1", "t1", ""));
  const auto timing =
      set_timing(context.get(), choose_device(context.get(), "").value(), "t7", std::nullopt);
  ASSERT_FALSE(timing);
  EXPECT_EQ(timing.error().message,
            "trigger=t7: no such trigger; there are: t0 (trigger0), t1 (trigger1)");
}

}  // namespace
}  // namespace proofmass::acquire::iio_columns_test
