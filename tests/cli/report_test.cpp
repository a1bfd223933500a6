#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "cli/process.h"
#include "cli/report_fixture.h"
#include "model/integrator.h"

namespace aspic {
namespace {

using test::aspic;
using test::content;
using test::fields;
using test::Report;
using test::Row;
using testing::HasSubstr;
using testing::Not;

TEST_F(Report, HasAllSectionsAndNoLinkElsewhere) {
  const std::string html = read("report.html"), markdown = read("report.md");
  for (const char* section : {"integrators", "parameters", "stability", "contact", "backends", "machine"})
    EXPECT_THAT(html, HasSubstr(fmt::format("id=\"{}\"", section)));
  for (const char* link : {"http:", "https:", "<script", "<link", "@import", "url(//"})
    EXPECT_THAT(html, Not(HasSubstr(link)));
  EXPECT_THAT(html,
              HasSubstr("aspic report cube-plane --set 'cube[0].particles-per-edge=4' --only stability"));
  for (const IntegratorRow& row : integrator_table) EXPECT_THAT(html, HasSubstr(row.title));
  // Every image of the Markdown page is there.
  const std::regex link(R"(\]\(([a-z0-9/.-]+)\))");
  std::size_t links = 0;
  for (auto at = std::sregex_iterator(markdown.begin(), markdown.end(), link); at != std::sregex_iterator();
       ++at) {
    EXPECT_TRUE(std::filesystem::exists(path((*at)[1]))) << (*at)[1];
    ++links;
  }
  EXPECT_GT(links, 40u);
  EXPECT_THAT(read("figures/order.svg"), HasSubstr("<svg"));
}

TEST_F(Report, MeasuredOrdersAreThoseOfTheory) {
  const auto rows = table("order-table");
  ASSERT_EQ(rows.size(), integrator_table.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i][0], integrator_table[i].title);
    EXPECT_EQ(std::stoi(rows[i][1]), integrator_table[i].order);
    EXPECT_NEAR(std::stod(rows[i][2]), integrator_table[i].order, 0.05) << rows[i][0];
  }
}

// Bisection to 0.2 % in single precision, where 960 steps tell growth of 1e-4 a step.
TEST_F(Report, MeasuredStableStepsAreThoseOfTheory) {
  const auto rows = table("largest-step");
  ASSERT_EQ(rows.size(), explicit_integrators.size());
  for (const Row& row : rows) EXPECT_NEAR(std::stod(row[2]) / std::stod(row[1]), 1.0, 0.01) << row[0];
}

/// A panel of a stability map.
struct Map {
  std::map<double, std::map<double, bool>> stable;  // by constant, by step
  std::map<double, double> limit;                   // of theory, by constant
};

TEST_F(Report, TheoryIsOnTheEdgeOfTheStabilityMapWithinOneCell) {
  for (const char* key : {"k", "c"}) {
    std::map<std::string, Map> maps;
    for (const Row& row : table(fmt::format("stability-{}", key))) {
      if (row[2].empty()) continue;
      Map& map = maps[row[0]];
      const double h = std::stod(row[2]), constant = std::stod(row[3]);
      if (row[1] == "stable" || row[1] == "unstable") {
        map.stable[constant][h] = row[1] == "stable";
      } else {
        map.limit[constant] = h;
      }
    }
    ASSERT_EQ(maps.size(), integrator_table.size());
    for (const IntegratorRow& row : integrator_table) {
      const Map& map = maps.at(std::string(row.title));
      ASSERT_GE(map.stable.size(), 10u);
      for (const auto& [constant, cells] : map.stable) {
        const double cell = std::next(cells.begin())->first / cells.begin()->first;
        double limit = std::numeric_limits<double>::infinity();
        if (!row.traits.stable_at_any_step) {
          // Theory is drawn at four places between rows: one is at this constant but for rounding.
          auto at = map.limit.lower_bound(constant * (1 - 1e-9));
          ASSERT_NE(at, map.limit.end()) << row.name;
          ASSERT_NEAR(at->first / constant, 1.0, 1e-6) << row.name;
          limit = at->second;
        }
        for (const auto& [h, stable] : cells) {
          if (h * cell >= limit && h <= limit * cell) continue;
          EXPECT_EQ(stable, h < limit) << row.name << ' ' << key << " = " << constant << ", h = " << h;
        }
      }
    }
  }
}

TEST_F(Report, ContactIsAsTheClosedFormsSay) {
  // Restitution of a particle: half a step's way at the apex and at the ground, ½gh² of 1 m each, and no
  // measure of height smaller than v·h at the lowest point, 4.4 mm.
  for (const Row& row : table("restitution-table")) {
    EXPECT_NEAR(std::stod(row[1]), std::stod(row[0]), 0.01) << "Coulomb";
    EXPECT_NEAR(std::stod(row[2]), std::stod(row[0]), 0.01) << "course";
  }
  // Friction: verify's bound for the slope, and what wobbles where it holds.
  for (const Row& row : table("friction-table")) EXPECT_NEAR(std::stod(row[2]), std::stod(row[1]), 0.02);
}

TEST_F(Report, BackendsAreEqual) {
  const auto rows = table("backends-table");
  EXPECT_GE(rows.size(), 8u);
  for (const Row& row : rows)
    EXPECT_EQ(row.back(), row[0] == "reference" ? "is the reference" : "yes") << row[0] << ' ' << row[2];
}

TEST_F(Report, ParametersShowWhatTheyDo) {
  const auto softest = table("parameter-k-table");
  ASSERT_EQ(softest.size(), 5u);
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_LT(std::stod(softest[i][2]), std::stod(softest[i - 1][2])) << "stiffer springs give way less";
  const auto steps = table("parameter-h-table");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(steps[i][1], i < 4 ? "ok" : "diverged");
}

/// Every number of a figure, in cells and in the titles of marks, is one of its CSV files.
TEST_F(Report, EveryNumberIsInTheCsvOfItsFigure) {
  const std::string html = read("report.html");
  const std::regex number(R"re(<data value="([^"]*)">|<title>([^<]*)</title>|href="(data/[^"]*)")re");
  std::size_t figures = 0, numbers = 0;
  for (std::size_t at = html.find("<figure"); at != std::string::npos;
       at = html.find("<figure", at + 1), ++figures) {
    const std::string figure = html.substr(at, html.find("</figure>", at) - at);
    std::vector<std::string> found;
    std::set<std::string> known;
    for (auto m = std::sregex_iterator(figure.begin(), figure.end(), number); m != std::sregex_iterator();
         ++m) {
      if ((*m)[1].matched) found.push_back((*m)[1]);
      if ((*m)[2].matched) {  // "name: x, y" of a mark, "x, y: stable" of a cell
        std::string title = (*m)[2];
        const bool cell = title.ends_with(": stable") || title.ends_with(": unstable");
        title = cell ? title.substr(0, title.rfind(": ")) : title.substr(title.rfind(": ") + 2);
        for (const std::string& word : fields(title))
          found.push_back(word.substr(word.find_first_not_of(' ')));
      }
      if ((*m)[3].matched) {
        for (const std::string& line : test::lines(read((*m)[3])))
          for (const std::string& field : fields(line)) known.insert(field);
      }
    }
    numbers += found.size();
    for (const std::string& value : found)
      EXPECT_TRUE(known.contains(value)) << value << " in figure " << figures + 1;
  }
  EXPECT_GE(figures, 16u);
  EXPECT_GT(numbers, 1000u);
}

TEST_F(Report, IsNotOverwrittenUnasked) {
  const auto again = aspic({"report", "--out", directory->file("r"), "--only", "contact"});
  EXPECT_EQ(again.exit_code, 6);
  EXPECT_THAT(again.err, HasSubstr("--force"));
}

TEST(ReportWithoutADevice, SaysSoAndHasNoImages) {
  const test::TemporaryDirectory dir;
  const test::ProcessOptions no_device = {{{"ASPIC_EGL_DEVICE", "97"}}, "", {}};
  const auto made = aspic({"report", "cube-plane", "--set", "cube[0].particles-per-edge=3", "--set",
                           "author=0356611", "--only", "backends", "--out", dir.file("r"), "--json"},
                          no_device);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("no images"));
  EXPECT_NE(test::json_member(made.out, "no_images"), "null");
  const std::string html = content(dir.file("r/report.html"));
  EXPECT_THAT(html, HasSubstr("There are no images"));
  EXPECT_THAT(html, HasSubstr("</h1><p class=\"by\">0356611</p>"));
  EXPECT_THAT(html, Not(HasSubstr("<img")));
}

// A sweep's row is the figure's: the command below a figure makes its numbers.
TEST_F(Report, CommandsOfFiguresMakeTheirNumbers) {
  const std::string html = read("report.html");
  const std::size_t figure = html.find("id=\"parameter-e\""), code = html.find("<code>aspic sweep", figure);
  ASSERT_NE(code, std::string::npos);
  std::string command = html.substr(code + 6, html.find("</code>", code) - code - 6);
  command = std::regex_replace(command, std::regex("'"), "");
  std::istringstream words(command);
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  ASSERT_EQ(arguments.front(), "aspic");
  arguments.erase(arguments.begin());
  const test::TemporaryDirectory dir;
  arguments.back() = dir.file("e.csv");
  const auto swept = aspic(arguments);
  ASSERT_EQ(swept.exit_code, 0) << swept.err << command;
  const std::vector<std::string> lines = test::lines(content(dir.file("e.csv")));
  const auto rows = table("parameter-e-table");
  ASSERT_EQ(lines.size(), rows.size() + 1);
  const Row header = fields(lines[0]);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(header, name) - header.begin());
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row row = fields(lines[i + 1]);
    EXPECT_EQ(row[column("squash")], rows[i][2]);
    EXPECT_EQ(row[column("rest_time")], rows[i][4]);
    EXPECT_EQ(row[column("slide")], rows[i][5]);
    EXPECT_EQ(row[column("total")], rows[i][6]);
  }
}

/// The page's image in a browser whose user wants it dark or light.
struct Screenshot {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;
  int brightness(int x, int y) const {
    const std::size_t at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return (rgb[at] + rgb[at + 1] + rgb[at + 2]) / 3;
  }
};

TEST_F(Report, OpensInABrowserInBothThemes) {
  for (const bool dark : {false, true}) {
    const std::string image = directory->file(dark ? "dark.png" : "light.png");
    test::ProcessOptions browser;
    browser.program = ASPIC_CHROMIUM;
    const auto shot =
        aspic({"--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1200,3000",
               fmt::format("--user-data-dir={}", directory->file("profile")),
               fmt::format("--blink-settings=preferredColorScheme={}", dark ? 0 : 1),
               fmt::format("--screenshot={}", image), fmt::format("file://{}", path("report.html"))},
              browser);
    ASSERT_EQ(shot.exit_code, 0) << shot.err;
    Screenshot s;
    int channels = 0;
    unsigned char* pixels = stbi_load(image.c_str(), &s.width, &s.height, &channels, 3);
    ASSERT_NE(pixels, nullptr);
    s.rgb.assign(pixels, pixels + 3 * static_cast<std::ptrdiff_t>(s.width) * s.height);
    stbi_image_free(pixels);
    ASSERT_EQ(s.width, 1200);
    EXPECT_EQ(s.brightness(5, 5) > 128, !dark) << s.brightness(5, 5);
    // Text and charts stand out from the paper, and charts have colors.
    int contrasting = 0, colored = 0;
    for (std::size_t i = 0; i + 2 < s.rgb.size(); i += 3) {
      const int low = std::min({s.rgb[i], s.rgb[i + 1], s.rgb[i + 2]}),
                high = std::max({s.rgb[i], s.rgb[i + 1], s.rgb[i + 2]});
      contrasting += dark ? high > 180 : low < 80;
      colored += high - low > 80;
    }
    EXPECT_GT(contrasting, 20000) << dark;
    EXPECT_GT(colored, 5000) << dark;
  }
}

}  // namespace
}  // namespace aspic
