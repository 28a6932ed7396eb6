#include "semantics/label_config.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(LabelClasses, ThePapersFiveAndTheAlias) {
    const auto classes = LabelClasses::Make({}, {});
    ASSERT_TRUE(classes.ok()) << classes.message();
    EXPECT_EQ(classes.value().count(), 5);
    EXPECT_EQ(classes.value().name(1), "computer");
    EXPECT_EQ(classes.value().IdOf("cup"), 5);
    EXPECT_EQ(classes.value().IdOf("tv"), 1);
    EXPECT_EQ(classes.value().IdOf("person"), 0);
    EXPECT_EQ(classes.value().colour(1), (Rgb8{0xe6, 0x40, 0x3a}));
}

TEST(LabelClasses, AllIsWhatTheDetectorKnowsAliasesJoined) {
    LabelConfig config;
    config.classes = "all cup=#010203";
    const auto classes = LabelClasses::Make(config, {"cell phone", "tv", "computer"});
    ASSERT_TRUE(classes.ok()) << classes.message();
    EXPECT_EQ(classes.value().count(), 3);  // cup, cell_phone, computer
    EXPECT_EQ(classes.value().IdOf("cell_phone"), classes.value().IdOf("cell phone"));
    EXPECT_EQ(classes.value().IdOf("tv"), classes.value().IdOf("computer"));
    EXPECT_EQ(classes.value().colour(classes.value().IdOf("cup")), (Rgb8{1, 2, 3}));
}

TEST(LabelClasses, WhatIsDynamicIsKnownByOurNames) {
    LabelConfig config;
    config.dynamic = "person office_chair";
    config.aliases = "man=person";
    const LabelClasses classes = LabelClasses::Make(config, {}).value();
    for (const char* name : {"person", "man", "office chair"})
        EXPECT_TRUE(classes.IsDynamic(name)) << name;
    EXPECT_FALSE(classes.IsDynamic("cup"));
    config.dynamic = "person=#010203";
    EXPECT_NE(config.Validate().message().find("labels.dynamic"), std::string::npos);
}

TEST(LabelClasses, ErrorsNameTheKey) {
    const auto error = [](const std::string& classes, const std::string& aliases,
                          const std::vector<std::string>& known = {}) {
        LabelConfig config;
        config.classes = classes;
        config.aliases = aliases;
        return LabelClasses::Make(config, known).message();
    };
    EXPECT_NE(error("", "").find("labels.classes"), std::string::npos);
    EXPECT_NE(error("cup cup", "").find("'cup' is empty or given twice"), std::string::npos);
    EXPECT_NE(error("cup=red", "").find("#rrggbb"), std::string::npos);
    EXPECT_NE(error("cup", "tv").find("labels.aliases"), std::string::npos);
    EXPECT_NE(error("cup", "", {"dog", "cat"}).find("knows none of them (it knows dog, ...)"),
              std::string::npos);
}

TEST(DistinctColour, TheFirstTwentyDiffer) {
    for (int a = 0; a < 20; ++a)
        for (int b = 0; b < a; ++b)
            EXPECT_FALSE(DistinctColour(a) == DistinctColour(b)) << a << " " << b;
}

TEST(LabelConfig, InputMustFitTheStrides) {
    LabelConfig config;
    config.input_px = 100;
    EXPECT_NE(config.Validate().message().find("labels.input_px"), std::string::npos);
    config.input_px = 416;
    EXPECT_TRUE(config.Validate().ok());
}

// Any detector's names can become ours, also names with blanks and several for one class.
TEST(LabelClasses, NamesOfAnotherDetector) {
    LabelConfig config;
    config.classes = "cup keyboard";
    config.aliases = "coffee_mug=cup mug=cup computer_key_board=keyboard";
    const std::vector<std::string> known = {"coffee mug", "mug", "computer key board", "pen"};
    const auto classes = LabelClasses::Make(config, known);
    ASSERT_TRUE(classes.ok()) << classes.message();
    EXPECT_EQ(classes.value().IdOf("coffee mug"), 1);
    EXPECT_EQ(classes.value().IdOf("mug"), 1);
    EXPECT_EQ(classes.value().IdOf("computer key board"), 2);
    EXPECT_EQ(classes.value().IdOf("pen"), 0);
    config.classes = "all";
    EXPECT_EQ(LabelClasses::Make(config, known).value().count(), 3);
}

// The default aliases rename televisions, but here they are what is asked for.
TEST(LabelClasses, ANameThatIsAskedForIsNotRenamed) {
    LabelConfig config;
    config.classes = "tv computer";
    const auto classes = LabelClasses::Make(config, {"tv", "monitor", "cup"});
    ASSERT_TRUE(classes.ok()) << classes.message();
    EXPECT_EQ(classes.value().IdOf("tv"), 1);
    EXPECT_EQ(classes.value().IdOf("monitor"), 2);
    EXPECT_EQ(classes.value().aliases(),
              (ClassAliases{{"tvmonitor", "computer"}, {"monitor", "computer"}}));
    config.classes = "tv";
    EXPECT_TRUE(LabelClasses::Make(config, {"tv", "cup"}).ok());
    config.classes = "all tv=#010203";
    const LabelClasses all = LabelClasses::Make(config, {"tv", "monitor", "cup"}).value();
    EXPECT_EQ(all.count(), 3);  // tv, computer, cup
    EXPECT_EQ(all.colour(all.IdOf("tv")), (Rgb8{1, 2, 3}));
    config.classes = "computer";
    config.dynamic = "tv";
    EXPECT_TRUE(LabelClasses::Make(config, {"tv", "monitor"}).value().IsDynamic("tv"));
}

TEST(LabelClasses, WhatCannotBeFoundIsTold) {
    LabelConfig config;
    const auto warning = [&](const std::vector<std::string>& known) {
        return WarningOf(config, LabelClasses::Make(config, known).value());
    };
    EXPECT_EQ(warning({"cup"}), "");  // the default list
    config.classes = "sofa=#010203 cup book person";
    EXPECT_EQ(warning({"couch", "cup", "person"}),
              "labels.classes: the detector does not know, or labels.dynamic takes: sofa, book, "
              "person");
    EXPECT_EQ(warning({"sofa", "cup", "book"}), warning({}));
    config.dynamic = "";
    EXPECT_EQ(warning({"sofa", "cup", "book", "person"}), "");
    config.classes = "all";
    EXPECT_EQ(warning({"cup", "person"}), "");
}

TEST(LabelClasses, WhatTheDetectorCanFind) {
    LabelConfig config;
    config.classes = "cup computer book person";
    const LabelClasses classes = LabelClasses::Make(config, {"cup", "tv", "person"}).value();
    EXPECT_TRUE(classes.CanBeFound(1));
    EXPECT_TRUE(classes.CanBeFound(2));   // as tv
    EXPECT_FALSE(classes.CanBeFound(3));  // it has no books
    EXPECT_FALSE(classes.CanBeFound(4));  // dynamic
    EXPECT_TRUE(LabelClasses::Make(config, {}).value().CanBeFound(3));
}

}  // namespace
}  // namespace tessera
