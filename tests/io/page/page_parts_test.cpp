// Tables, packed numbers, and the data that a page's view is drawn from.

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

#include "io/page/html_table.h"
#include "io/page/packed.h"
#include "io/page/page_files.h"
#include "io/page/solution_data.h"
#include "io/read_run_report.h"
#include "solver/model/error.h"
#include "tests/support/written_sheets.h"

namespace clerestory {
namespace {

std::vector<std::uint8_t> from_base64(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto digit = std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
    if (digit == std::string::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(digit), count += 6;
    if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
  }
  return bytes;
}

template <class Number>
std::vector<Number> unpacked(const std::string& text, std::size_t n) {
  const auto stored = from_base64(text);
  std::vector<std::uint8_t> planes(n * sizeof(Number));
  vtkNew<vtkZLibDataCompressor> zlib;
  EXPECT_EQ(zlib->Uncompress(stored.data(), stored.size(), planes.data(), planes.size()), planes.size());
  std::vector<Number> numbers(n);
  auto* bytes = reinterpret_cast<std::uint8_t*>(numbers.data());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < sizeof(Number); ++k) bytes[i * sizeof(Number) + k] = planes[k * n + i];
  return numbers;
}

std::string element(const std::string& page, const std::string& name) {
  const std::string head = "id=\"solution-" + name + "\">";
  const std::size_t begin = page.find(head);
  EXPECT_NE(begin, page.npos) << name;
  return page.substr(begin + head.size(), page.find("</script>", begin) - begin - head.size());
}

TEST(Base64, IsAsItsStandardSays) {  // RFC 4648, section 10
  const auto encoded = [](std::string_view s) {
    return base64({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()});
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(HtmlTable, EscapesWhateverItIsGiven) {
  HtmlTable table({"<name", "lx"});
  EXPECT_TRUE(table.empty());
  table.add({"<script>alert('\"&')</script>", "\xff\xfe"});
  const std::string html = table.html();
  EXPECT_EQ(html.find("<script"), html.npos) << html;
  EXPECT_NE(html.find("&lt;script&gt;alert('&quot;&amp;')"), html.npos) << html;
  EXPECT_NE(html.find("<td>?"
                      "?</td>"),
            html.npos)
      << html;
}

TEST(SolutionData, DecodesToTheNumbersOfTheResult) {
  WrittenResult r =
      written_sheets(4, [](double x, double y) { return 1e-3 + 100 * x * x + 10 * y; }, 3, {1e6, -2e6, 30});
  r.surfaces[2] = "</script><script>alert(1)";
  r.around.luminaires = {{{1e6 + 1, -2e6, 33}, "", "", 100}};
  r.around.panes = {{{Vec3{1e6, -2e6, 30}, {1e6 + 4, -2e6, 30}, {1e6, -2e6 + 1, 31}}, 0, 0}};
  const std::vector<double> levels = {100, 200};
  const SolutionData data = solution_data(r, levels, 10, 1000);
  EXPECT_EQ(data.parts, (std::vector<std::string>{"all rooms", "room 0", "room 1"}));

  const auto head = nlohmann::json::parse(element(data.elements, "head"));
  EXPECT_EQ(head["surfaces"][2], r.surfaces[2]);
  EXPECT_EQ(data.elements.find("<script>alert"), data.elements.npos);
  EXPECT_EQ(head["centre"], (nlohmann::json{1e6 + 2, -2e6 + 0.5, 30.0}));
  EXPECT_EQ(head["luminaires"][0], (nlohmann::json{-1.0, -0.5, 3.0}));

  const auto codes = unpacked<std::uint32_t>(element(data.elements, "corners"), 24);
  const auto light = unpacked<std::uint16_t>(element(data.elements, "light"), 16);
  const auto position = unpacked<float>(element(data.elements, "positions"), 48);
  const auto runs = unpacked<std::uint32_t>(element(data.elements, "runs"), 16);
  EXPECT_EQ(unpacked<float>(element(data.elements, "panes"), 9)[3], 2);
  EXPECT_EQ((std::vector(runs.begin() + 8, runs.begin() + 12)), (std::vector<std::uint32_t>{2, 1, 2, 0}));
  const double low = head["light"][0], high = head["light"][1];
  std::uint32_t next = 0;
  for (std::size_t k = 0; k < codes.size(); ++k) {
    const std::uint32_t corner = next - codes[k];
    if (codes[k] == 0) ++next;
    const std::uint32_t p = r.triangles[k / 3][k % 3];  // in order already: nothing is sorted anew
    const Vec3 x = Vec3{position[3 * corner], position[3 * corner + 1], position[3 * corner + 2]} +
                   Vec3{head["centre"][0], head["centre"][1], head["centre"][2]};
    EXPECT_EQ(x, r.points[p]);
    const double lux = low * std::pow(high / low, (light[corner] - 1) / 65534.0);
    EXPECT_NEAR(lux, r.of_points.at("illuminance").value[p], 2e-4 * lux);
  }
}

TEST(SolutionData, OfADarkSceneIsDark) {
  const SolutionData data = solution_data(written_sheets(1, [](double, double) { return 0.0; }), {}, 1, 1000);
  EXPECT_EQ(unpacked<std::uint16_t>(element(data.elements, "light"), 4), (std::vector<std::uint16_t>(4, 0)));
}

TEST(PageFiles, HaveNoAddressThatABrowserWouldAskFor) {
  const PageFiles files = read_page_files();
  EXPECT_FALSE(files.style.empty());
  EXPECT_EQ(files.style.find("url("), files.style.npos);
  EXPECT_EQ(files.style.find("@import"), files.style.npos);
  EXPECT_EQ(files.viewer.empty(), !files.why_no_viewer.empty());
  EXPECT_EQ(files.viewer.empty(), files.viewer_licence.find("Permission is hereby granted") == std::string::npos);
  EXPECT_EQ(files.viewer.find("</script"), files.viewer.npos);
}

TEST(RunReport, IsReadBackAsItWasWritten) {
  RunReport report = new_report("room.json");
  report.method = "hierarchical";
  report.settings = {{"accuracy", std::string("draft")}, {"seed", 7LL}, {"tighten", 0.5}, {"debug", true}};
  report.counts.rays = 123;
  report.energy = {10, 6, 4};
  report.error = RunReport::Error{0.1, 0.02, 0.3, 50, 0.01, true};
  report.error_spaces = {{"A", 12, 300, *report.error}, {"B", 3, 0, {}}};
  report.worst_space = 0;
  report.luminaires = {{"file", "lamp.ies", "east", 3, 900, 310, 300, 400}};
  report.daylight = Daylight{{30, 180}, Moment{2026, 6, 21, 12.5}, Daylight::Hour{"city.epw", 6, 21, 13}};
  report.spaces = {{"R", "Room", 20, 3, 60}};
  report.not_read = {{"lamps", 2, "L1"}};
  report.warnings = {"<b>"}, report.left_out = {"mirrors"};
  const RunReport back = run_report_of(repeatable_text(report), "a.vtp");
  EXPECT_EQ(repeatable_text(back).substr(0, 100), repeatable_text(report).substr(0, 100));
  EXPECT_EQ(back.settings.size(), 4u);
  EXPECT_EQ(std::get<double>(back.settings[2].value), 0.5);
  EXPECT_EQ(back.counts.rays, 123u);
  EXPECT_EQ(back.energy.escaped, 4);
  EXPECT_EQ(back.error->p95_relative, 0.3);
  EXPECT_TRUE(back.error->bound);
  EXPECT_EQ(back.error_spaces.size(), 2u);
  EXPECT_EQ(back.error_spaces[1].error.samples, 0u);
  EXPECT_EQ(back.worst_space, 0u);
  EXPECT_EQ(back.luminaires[0].lamp_flux, 400);
  EXPECT_EQ(back.daylight->time->hour, 12.5);
  EXPECT_EQ(back.daylight->weather->day, 21);
  EXPECT_EQ(back.spaces[0].volume, 60);
  EXPECT_EQ(back.not_read[0].count, 2u);
  EXPECT_EQ(back.warnings, report.warnings);
}

TEST(RunReport, ThatIsDamagedIsRefused) {
  EXPECT_NO_THROW(run_report_of("", "a.vtp"));
  for (const char* json : {"{", "[]", "{\"version\":3}", "{\"error\":{\"spaces\":[1]}}", "{\"counts\":7}",
                           "{\"settings\":{\"a\":[]}}", "{\"warnings\":[1]}"})
    EXPECT_THROW(run_report_of(json, "a.vtp"), InputError) << json;
}

}  // namespace
}  // namespace clerestory
