// clerestory report, run as a user runs it.

#include <filesystem>

#include <gtest/gtest.h>

#include "tests/support/run_program.h"
#include "tests/support/solved_box.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// A closed room with sensors.
class Report : public testing::Test {
 protected:
  Report() {
    MeasuredSensors desk;
    desk.set.name = "desk";
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 6; ++i) {
        desk.set.points.push_back({{0.75 + 0.5 * i, 0.75 + 0.5 * j, 0.8}, {0, 0, 1}});
        desk.illuminance.push_back(400 + 10.0 * i);
      }
    SolvedBox lit;
    lit.around.sensors = {desk};
    result_ = lit.write(folder_);
  }

  std::string in_folder(const std::string& name) { return folder_ / name; }
  ProgramRun report(std::vector<std::string> more) {
    more.insert(more.begin(), {"report", result_});
    return run_program(more);
  }
  /// It says why, and leaves no page.
  void expect_refused(const std::vector<std::string>& more, int code, const std::string& words) {
    fs::remove(in_folder("no.html"));
    const ProgramRun run = report(more);
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(in_folder("no.html")));
  }

  TempFolder folder_;
  std::string result_;
};

TEST_F(Report, WritesOnePageThatIsTheSameEachTime) {
  const ProgramRun run = report({"-o", in_folder("a.html"), "--target", "desk=500"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("a.html"), std::string::npos);
  const std::string page = read_text(in_folder("a.html"));
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>")) << page.substr(0, 100);
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_NE(page.find("<h1>room.json</h1>"), std::string::npos);
  EXPECT_NE(page.find("the target</span>"), std::string::npos);
  ASSERT_EQ(report({"-o", in_folder("b.html"), "--target", "desk=500", "--threads", "1"}).exit_code, 0);
  EXPECT_EQ(page, read_text(in_folder("b.html")));
}

TEST_F(Report, RefusesWhatItCannotUse) {
  const std::string no = in_folder("no.html");
  expect_refused({"-o", no, "--target", "desc=500"}, 3, "did you mean 'desk'?");
  expect_refused({"-o", no, "--target", "desk=much"}, 2, "LUX or NAME=LUX");
  expect_refused({"-o", no, "--target", "-5"}, 2, "above 0 lx");
  expect_refused({"-o", no, "--target", "nan"}, 2, "above 0 lx");
  expect_refused({"-o", in_folder("no.pdf")}, 2, "does not end in .html");
  expect_refused({}, 2, "--output");
  expect_refused({"-o", in_folder("missing/no.html")}, 3, "missing");
}

TEST_F(Report, RefusesWhatIsNoResult) {
  const std::string whole = read_text(result_);
  const auto refused = [&](const std::string& content, const std::string& words) {
    const TempFolder own;
    const std::string page = own / "no.html";
    const ProgramRun run = run_program({"report", own.write("bad.vtp", content), "-o", page});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(page));
  };
  refused("{}", "is no VTK PolyData");
  refused(whole.substr(0, whole.size() / 2), "damaged");
  EXPECT_EQ(run_program({"report", in_folder("nowhere.vtp"), "-o", in_folder("no.html")}).exit_code, 3);
}

TEST_F(Report, NeverWritesOverItsInput) {
  const std::string before = read_text(result_);
  fs::create_symlink(result_, in_folder("link.html"));
  const ProgramRun run = report({"-o", in_folder("link.html")});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_EQ(read_text(result_), before);
}

}  // namespace
}  // namespace clerestory
