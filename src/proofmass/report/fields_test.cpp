#include "proofmass/report/fields.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace proofmass::report::fields_test {
namespace {

using Reasons = std::vector<std::string>;

TEST(Fields, AreWrittenInTheirOrder) {
  const Fields fields{field::count("samples", 3), field::number("rate_hz", 100.0),
                      field::list("axis", {field::number({}, 0.0), field::number({}, 1.0)}),
                      field::object("inner", {field::flag("yes", true)})};
  EXPECT_EQ(json_text(json_of(fields)),
            "{\n  \"samples\": 3,\n  \"rate_hz\": 100.0,\n  \"axis\": [\n    0.0,\n    1.0\n  ],\n"
            "  \"inner\": {\n    \"yes\": true\n  }\n}");
}

TEST(Fields, ANumberThatIsNotFiniteIsAbsent) {
  EXPECT_TRUE(is_absent(field::number("a", std::nan(""))));
  EXPECT_TRUE(is_absent(field::measured("a", Uncertain{1.0, INFINITY}, "m")));
  EXPECT_FALSE(is_absent(field::number("a", 0.0)));
}

TEST(ReasonsForNulls, NameTheKeyAtTheTop) {
  EXPECT_EQ(reasons_for_nulls(
                {field::measured("turns", std::nullopt, "turn", {.why_null = "the angle was lost"}),
                 field::count("samples", 1)}),
            Reasons{"turns: null: the angle was lost"});
}

TEST(ReasonsForNulls, AreNotNamedAfterTheFileOfTheDocument) {
  EXPECT_EQ(reasons_for_nulls({field::text("file", "a.csv"),
                               field::text_or_null("unit", "", {.why_null = "not stated"})}),
            Reasons{"unit: null: not stated"});
}

TEST(ReasonsForNulls, JoinTheKeysOfAnObjectThatHaveOneReason) {
  const auto absent = [](const char* key, const char* why) {
    return field::measured(key, std::nullopt, "1", {.why_null = why});
  };
  const Field sensors = field::list(
      "sensors",
      {field::object({}, {field::text("file", "a.csv"), absent("radius_m", "still"),
                          field::list("bias", {absent("", "still"),
                                               field::measured({}, Uncertain{1, 1}, "1")}),
                          absent("skew_rad", "slow")})});
  EXPECT_EQ(reasons_for_nulls({sensors}),
            (Reasons{"sensors[0] (a.csv): radius_m, bias[0]: null: still",
                     "sensors[0] (a.csv): skew_rad: null: slow"}));
}

TEST(ReasonsForNulls, GiveTheWholePathOfASingleKey) {
  EXPECT_EQ(
      reasons_for_nulls({field::object(
          "methods", {field::object("atan2", {field::number("turns_std", std::nullopt,
                                                            {.why_null = "it has none"})})})}),
      Reasons{"methods.atan2.turns_std: null: it has none"});
}

TEST(ReasonsForNulls, GiveTheReasonOfAnAbsentObjectOnce) {
  EXPECT_EQ(reasons_for_nulls(
                {field::object_or_null("gyroscope", std::nullopt, {.why_null = "there is none"})}),
            Reasons{"gyroscope: null: there is none"});
}

TEST(ReasonsForNulls, JoinTheObjectsOfAListThatHaveThem) {
  const std::vector<int> four(4);
  const Field points = field::records("points", four, [](int) -> Fields {
    return {field::number("p", std::nullopt, {.why_null = "the noise is not known"})};
  });
  EXPECT_EQ(reasons_for_nulls({points}),
            Reasons{"points[]: p: null (4 times): the noise is not known"});
}

TEST(Fields, AQuantityMayLackItsStandardDeviationAlone) {
  const Field bias = field::measured("bias", 0.5, std::nullopt, "V", {.why_no_std = "four points"});
  EXPECT_EQ(
      json_text(json_of({bias})),
      "{\n  \"bias\": {\n    \"value\": 0.5,\n    \"std\": null,\n    \"unit\": \"V\"\n  }\n}");
  EXPECT_EQ(reasons_for_nulls({bias}), Reasons{"bias.std: null: four points"});
  EXPECT_EQ(shown_value(bias), "0.500000 V");
}

TEST(Fields, WithoutValueKeepTheirKeyAndTheirReason) {
  const Field none = field::without_value(field::count("samples", 3), "not analysed");
  EXPECT_EQ(json_text(json_of({none})), "{\n  \"samples\": null\n}");
  EXPECT_EQ(reasons_for_nulls({none}), Reasons{"samples: null: not analysed"});
  EXPECT_TRUE(is_absent(field::without_value(field::list("rests", {}), "not analysed")));
}

TEST(Fields, ALongListIsWrittenFromItsElements) {
  std::vector<int> elements{1, 2};
  const Field list =
      field::long_records("a", elements, [](int k) { return Fields{field::integer("k", k)}; });
  elements[1] = 7;
  EXPECT_EQ(json_text(json_of({list})),
            "{\n  \"a\": [\n    {\n      \"k\": 1\n    },\n    {\n      \"k\": 7\n    }\n  ]\n}");
  const std::vector<int> none;
  EXPECT_EQ(json_text(json_of({field::long_records(
                "a", none, [](int k) { return Fields{field::integer("k", k)}; })})),
            "{\n  \"a\": []\n}");
}

TEST(Fields, WholeNumbersMayBeNegative) {
  EXPECT_EQ(json_text(json_of({field::integer("alpha", -2)})), "{\n  \"alpha\": -2\n}");
  EXPECT_TRUE(is_absent(field::integer("alpha", std::nullopt)));
}

TEST(ShownValue, IsInTheDisplayUnit) {
  const Field angle = field::measured("angle_rad", Uncertain{1.0, 0.01}, "rad",
                                      {.display = Display{"°", 180.0 / 3.14159265358979}});
  EXPECT_EQ(shown_value(angle), "57.3 ± 0.6°");
  EXPECT_EQ(shown_value(field::measured("x", std::nullopt, "m")), "not determined");
  EXPECT_EQ(shown_value(field::list("axis", {field::number({}, 0.5), field::number({}, 1.0)})),
            "(0.5000, 1.000)");
}

}  // namespace
}  // namespace proofmass::report::fields_test
