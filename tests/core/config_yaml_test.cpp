// Tests of the YAML side of core/config.h: nesting, all-or-nothing loading, round trips, hostile
// files.
#include <gtest/gtest.h>

#include <fstream>

#include "core/config.h"
#include "support/temp_folder.h"

namespace tessera {
namespace {

class ConfigYaml : public testing::Test {
  protected:
    void SetUp() override {
        parameters.Add("name", name, "A text.");
        parameters.Section("a", [&](ConfigParameters& p) {
            p.Add("x", x, {0, 10}, "m", "A number.");
            p.Section("deep", [&](ConfigParameters& q) { q.Add("n", n, {0, 10}, "", "A count."); });
        });
        parameters.Section("b", [&](ConfigParameters& p) { p.Add("on", on, "A switch."); });
    }
    Status Load(const std::string& yaml) { return parameters.LoadYaml(yaml, "my.yaml"); }

    double x = 1;
    int n = 2;
    bool on = false;
    std::string name = "first";
    ConfigParameters parameters;
};

TEST_F(ConfigYaml, NestsAsTheSectionsDo) {
    const Status status = Load("a:\n  x: 2.5\n  deep:\n    n: 7\nb: {on: true}\n");
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(x, 2.5);
    EXPECT_EQ(n, 7);
    EXPECT_TRUE(on);
    EXPECT_EQ(name, "first");  // a missing key keeps its value
}

TEST_F(ConfigYaml, AnEmptyFileChangesNothing) {
    EXPECT_TRUE(Load("").ok());
    EXPECT_TRUE(Load("# only a comment\n").ok());
}

TEST_F(ConfigYaml, OneErrorLeavesEverythingAsItWas) {
    for (const char* bad :
         {"a: {x: 3, deep: {n: 99}}", "name: other\na: {x: 3}\nc: 1", "a: {x: 3}\nb: {on: [1]}"}) {
        const Status status = Load(bad);
        EXPECT_FALSE(status.ok()) << bad;
        EXPECT_EQ(status.message().rfind("my.yaml: ", 0), 0u) << status.message();
        EXPECT_EQ(x, 1);
        EXPECT_EQ(n, 2);
        EXPECT_EQ(name, "first");
    }
}

TEST_F(ConfigYaml, WhatItWritesItReads) {
    const std::string awkward[] = {"",           "null", "~", "a: b # c", "\"quoted\" \\ back",
                                   "two\nlines", "-",    "5", "tab\t\x01"};
    for (const std::string& text : awkward) {
        name = text;
        x = 0.1 + 0.2;
        n = 9;
        on = true;
        const std::string yaml = parameters.ToYaml();
        name = "other";
        x = n = 0;
        on = false;
        const Status status = Load(yaml);
        ASSERT_TRUE(status.ok()) << status.message() << "\n" << yaml;
        EXPECT_EQ(name, text);
        EXPECT_EQ(x, 0.1 + 0.2);
        EXPECT_EQ(n, 9);
        EXPECT_TRUE(on);
    }
}

TEST_F(ConfigYaml, RefusesWhatIsNoMapping) {
    for (const char* bad : {"just text", "[1, 2]", "a: [1]", "a:", "a: 5", "{", "a: {x: }",
                            "? [1]\n: 2", "a: *nowhere"})
        EXPECT_FALSE(Load(bad).ok()) << bad;
}

TEST_F(ConfigYaml, HostileDepthAndAliasesAreRefusedQuickly) {
    std::string nested;
    for (int i = 0; i < 100000; ++i) nested += "{a: ";
    EXPECT_FALSE(Load(nested).ok());
    EXPECT_FALSE(Load(std::string(100000, '[')).ok());
    EXPECT_FALSE(Load("a: {a: {a: {a: {a: {a: {a: {a: {a: {a: 1}}}}}}}}}}").ok());

    std::string bomb = "l0: &l0 {}\n";  // expands to 20^7 nodes if the aliases are followed
    for (int level = 1; level < 8; ++level) {
        bomb += fmt::format("l{0}: &l{0} {{", level);
        for (int i = 0; i < 20; ++i) bomb += fmt::format("k{}: *l{}, ", i, level - 1);
        bomb += "}\n";
    }
    EXPECT_FALSE(Load(bomb).ok());
}

TEST_F(ConfigYaml, KeysAndValuesFromOutsideAreShownSafely) {
    EXPECT_EQ(Load("a: {x: 4, x: 5}").message(), "my.yaml: a.x: is given twice");
    for (const std::string& text :
         {std::string("a: {x: \"\\e[2J\"}"), std::string("\x1b[2J: 3"),
          "a: {x: " + std::string(5000, 'y') + "}", std::string(5000, 'k') + ": 3"}) {
        const std::string message = Load(text).message();
        EXPECT_EQ(message.find('\x1b'), std::string::npos);
        EXPECT_GT(message.size(), 10u);
        EXPECT_LT(message.size(), 300u);
    }
}

TEST_F(ConfigYaml, FilesThatCannotBeReadAreNamed) {
    const TempFolder folder;
    EXPECT_EQ(parameters.LoadYamlFile(folder / "none.yaml").message(),
              folder / "none.yaml: no such file");
    EXPECT_EQ(parameters.LoadYamlFile(folder.path()).message(),
              folder.path() + ": is a folder; give a file");
    std::ofstream(folder / "my.yaml") << "a: {x: 4}\n";
    EXPECT_TRUE(parameters.LoadYamlFile(folder / "my.yaml").ok());
    EXPECT_EQ(x, 4);
}

}  // namespace
}  // namespace tessera
