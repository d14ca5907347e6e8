#include "proofmass/report/page/json.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/report/json.hpp"

namespace proofmass::report::page_json_test {
namespace {

Page small_page() {
  Figure figure{.title = "Deviation",
                .description = "of x",
                .x = {.label = "τ (s)", .scale = AxisScale::log},
                .y = {.label = "g"}};
  figure.curves = {{.label = "measured",
                    .x = {1.0, 2.0, 4.0},
                    .y = {3.0, gap, 1.0},
                    .ink = Ink::orange,
                    .mark = Mark::dashes}};
  figure.bands = {{.label = "limits", .x = {1.0}, .lower = {2.0}, .upper = {4.0}}};
  Table rows{"many", {"k"}, {}};
  for (int k = 0; k < 150; ++k) rows.rows.push_back({std::to_string(k)});
  rows.long_list = true;
  return {.verb = "noise",
          .title = "a \"b\"",
          .inputs = {"a.csv"},
          .conclusion = "White noise.",
          .key_figures = {{"N", "1 ± 0.1"}},
          .notes = {{Severity::warning, "odd"}},
          .sections = {{.heading = "x", .tables = {rows}, .figures = {figure}}}};
}

bool holds(const std::string& part) {
  std::string text = page_json(small_page());
  std::erase(text, ' ');
  std::erase(text, '\n');
  return text.find(part) != std::string::npos;
}

TEST(PageJson, HasTheFiguresAsNumbersWithGapsAsNull) {
  EXPECT_TRUE(holds(R"("x":[1.0,2.0,4.0],"y":[3.0,null,1.0])"));
  EXPECT_TRUE(holds(R"("ink":"orange","mark":"dashes")"));
  EXPECT_TRUE(holds(R"j("x":{"label":"τ(s)","scale":"log","min":null,"max":null})j"));
  EXPECT_TRUE(holds(R"("lower":[2.0],"upper":[4.0])"));
}

TEST(PageJson, HasTheWordsOfThePage) {
  EXPECT_TRUE(holds(R"("title":"a\"b\"")"));
  EXPECT_TRUE(holds(R"({"label":"N","value":"1±0.1"})"));
  EXPECT_TRUE(holds(R"({"severity":"warning","text":"odd"})"));
}

TEST(PageJson, CutsLongListsAndSaysHowManyRowsThereAre) {
  EXPECT_TRUE(holds(R"(["99"]],"rows_in_all":150)"));
}

TEST(PageJson, ThinsLongCurvesWithoutLosingASpike) {
  Curve curve{.label = "", .x = {}, .y = {}};
  for (int k = 0; k < 100'000; ++k) {
    curve.x.push_back(k);
    curve.y.push_back(k == 77'777 ? 1234.5 : 0.0);
  }
  Figure figure{.title = "t", .description = "d", .x = {.label = "x"}, .y = {.label = "y"}};
  figure.curves = {curve};
  Page page{.verb = "v", .title = "t", .inputs = {}, .conclusion = "c"};
  page.sections = {{.heading = "h", .figures = {figure}}};
  const std::string text = page_json(page);
  EXPECT_LT(text.size(), 400'000U);
  EXPECT_NE(text.find("1234.5"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::report::page_json_test
