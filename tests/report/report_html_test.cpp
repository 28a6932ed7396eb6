#include "report/report_html.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/input_file.h"
#include "report/made_up_run.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class Report : public testing::Test {
  protected:
    Report() {
        WriteMadeUpRun(folder.path());
        options.version = "1.2.3";
        options.settings = {{"a.number", "m", "1.5"}, {"a.text", "", "x"}};
    }
    std::string Page() {
        const std::string path = folder / "page.html";
        Result<WrittenReport> written = WriteReport(folder.path(), path, options);
        EXPECT_TRUE(written.ok()) << written.message();
        if (!written.ok()) return {};
        report = written.value();
        return ReadWholeFile(path, 1 << 28).value();
    }
    void Remove(const std::string& name) const { std::filesystem::remove(folder / name); }
    void Write(const std::string& name, const std::string& text) const {
        ASSERT_TRUE(WriteTextFile(folder / name, text).ok());
    }
    static bool Has(const std::string& page, const std::string& id) {
        return page.find("<section id=\"" + id + "\">") != std::string::npos;
    }
    static std::size_t Count(const std::string& text, const std::string& part) {
        std::size_t count = 0;
        for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
        return count;
    }

    TempFolder folder;
    ReportOptions options;
    WrittenReport report;
};

TEST_F(Report, ACompleteRunHasAllParts) {
    const std::string page = Page();
    for (const char* id :
         {"model", "tracking", "error", "times", "loops", "objects", "settings", "again"})
        EXPECT_TRUE(Has(page, id)) << id;
    EXPECT_FALSE(Has(page, "damaged"));
    EXPECT_FALSE(Has(page, "left-out"));
    EXPECT_TRUE(report.left_out.empty());
    for (const char* id : {"vertices", "corners", "poses", "tracked", "truth"})
        EXPECT_EQ(Count(page, fmt::format("<script type=\"text/plain\" id=\"{}\">", id)), 1u);
    EXPECT_EQ(page.find("a.number"), std::string::npos);  // has its default value
    EXPECT_NE(page.find("unknown to this version"), std::string::npos);
}

TEST_F(Report, TextFromOutsideCannotBreakOut) {
    const std::string page = Page();
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
    EXPECT_EQ(page.find("<script>alert"), std::string::npos);
    EXPECT_EQ(page.find("<b>no view"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;no view&lt;/b&gt;"), std::string::npos);
    // Exactly our own elements: data, five of base64, the program.
    EXPECT_EQ(Count(page, "<script"), 7u);
    EXPECT_EQ(Count(page, "</script"), 7u);
    const std::string begin = "id=\"data\">";
    const auto from = page.find(begin) + begin.size();
    const auto data = nlohmann::json::parse(page.substr(from, page.find("</script", from) - from));
    EXPECT_EQ(data["objects"][0]["name"], kHostile);
}

TEST_F(Report, NothingIsLoaded) {
    const std::string page = Page();
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    for (const char* way : {"http:", "https:", "src=\"", "url(", "@import", "fetch(", "import("})
        EXPECT_EQ(page.find(way), std::string::npos) << way;
}

TEST_F(Report, TheSameBytesForTheSameRun) {
    const std::string first = Page();
    EXPECT_EQ(first, Page());
}

TEST_F(Report, EachMissingFileIsSaidInOneLine) {
    const std::vector<std::pair<std::string, std::string>> parts = {
        {"frames.csv", "tracking"}, {"objects.json", "objects"}, {"run.json", "again"}};
    for (const auto& [file, id] : parts) {
        Remove(file);
        const std::string page = Page();
        EXPECT_FALSE(Has(page, id)) << id;
        EXPECT_NE(page.find("<li>No " + file + ": "), std::string::npos) << file;
    }
    for (const char* file : {"timings.json", "groundtruth.txt", "trajectory_tracked.txt"})
        Remove(file);
    const std::string page = Page();
    for (const char* id : {"error", "times", "loops"}) EXPECT_FALSE(Has(page, id)) << id;
    EXPECT_EQ(report.left_out.size(), 5u);
    EXPECT_TRUE(report.damaged.empty());
}

TEST_F(Report, AMeshOrAPathIsEnough) {
    for (const char* kept : {"mesh.ply", "trajectory.txt"}) {
        TempFolder one;
        std::filesystem::copy(folder / kept, one / kept);
        const auto written = WriteReport(one.path(), one / "page.html", options);
        EXPECT_TRUE(written.ok()) << written.message();
        EXPECT_GE(written.value().left_out.size(), 5u);
    }
    TempFolder none;
    const auto nothing = WriteReport(none.path(), none / "page.html", options);
    ASSERT_FALSE(nothing.ok());
    EXPECT_NE(nothing.message().find(none.path()), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(none / "page.html"));
    EXPECT_FALSE(WriteReport(folder / "mesh.ply", none / "page.html", options).ok());
}

TEST_F(Report, DamageIsSaidAndTheRestShown) {
    std::ofstream(folder / "frames.csv", std::ios::app) << "garbage\n";
    Write("timings.json", "[1, 2]");
    Write("objects.json", "{");
    const std::string page = Page();
    EXPECT_TRUE(Has(page, "damaged"));
    EXPECT_TRUE(Has(page, "tracking"));
    ASSERT_EQ(report.damaged.size(), 3u);
    EXPECT_NE(report.damaged[0].find("frames.csv:32: 1 values instead of 14"), std::string::npos);
    Write("mesh.ply", "ply\nnonsense");
    EXPECT_TRUE(Has(Page(), "tracking"));
    EXPECT_EQ(report.damaged.size(), 4u);
}

TEST_F(Report, SettingsOfAnotherTypeAreNoCrash) {
    Write("run.json", R"({"version": 3, "counts": {"frames": "many"}})");
    Page();
    ASSERT_EQ(report.damaged.size(), 1u);
    EXPECT_NE(report.damaged[0].find("run.json"), std::string::npos);
}

TEST_F(Report, AGivenTruthMustBeReadable) {
    options.truth = folder / "nowhere.txt";
    const auto written = WriteReport(folder.path(), folder / "page.html", options);
    ASSERT_FALSE(written.ok());
    EXPECT_NE(written.message().find("nowhere.txt"), std::string::npos);
}

TEST_F(Report, AGivenTruthNeedsAPath) {
    Remove("trajectory.txt");
    options.truth = folder / "groundtruth.txt";
    const auto written = WriteReport(folder.path(), folder / "page.html", options);
    ASSERT_FALSE(written.ok());
    EXPECT_NE(written.message().find("no readable trajectory.txt"), std::string::npos);
}

TEST_F(Report, LinesOfTheTruthThatAreLeftOutAreSaid) {
    std::ofstream(folder / "groundtruth.txt", std::ios::app) << "1 2 3\n";
    EXPECT_TRUE(Has(Page(), "error"));
    ASSERT_EQ(report.damaged.size(), 1u);
    EXPECT_NE(report.damaged[0].find("3 numbers, not 8; skipped"), std::string::npos);
}

TEST_F(Report, ErrorsAreThoseOfEval) {
    const std::string page = Page();
    const AteResult ate = EvaluateAte(MadeUpPath(0.11), MadeUpPath(0.1)).value();
    EXPECT_NE(page.find(fmt::format("<td>RMSE</td><td>{:.2f} mm</td>", 1000 * ate.error_m.rmse)),
              std::string::npos);
}

TEST_F(Report, ALargeModelIsMadeCoarserAndSaysSo) {
    options.most_triangles = 200;
    const std::string page = Page();
    EXPECT_NE(page.find("The model has 800 triangles; this page shows 1"), std::string::npos);
    EXPECT_EQ(page.find("\"triangles\":800"), std::string::npos);
}

TEST(ReportHtml, ALargeCloudOfPointsIsThinnedAndSaysSo) {
    ReportData data;
    data.mesh = BumpySheet(20);  // 21 x 21 vertices
    data.mesh->triangles.clear();
    ReportOptions options;
    options.most_triangles = 200;
    const std::string page = ReportHtml(std::move(data), options);
    EXPECT_NE(page.find("<b>441</b><span>points</span>"), std::string::npos);
    EXPECT_NE(page.find("The model has 441 points; this page shows 147, evenly chosen."),
              std::string::npos);
}

}  // namespace
}  // namespace tessera
