#include "core/state_stream.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessera {
namespace {

std::vector<std::uint8_t> Everything() {
    std::vector<std::uint8_t> bytes;
    StateWriter state(bytes);
    state.Put(std::int32_t{-7});
    state.Put(true);
    state.Put(std::string("a word"));
    state.Put(Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
    state.Put(std::optional<Eigen::Vector2d>());
    state.Put(std::optional<Eigen::Vector2d>(Eigen::Vector2d(4, 5)));
    const float values[] = {1.5f, -2.5f};
    state.PutArray(std::span<const float>(values));
    return bytes;
}

bool GetEverything(std::span<const std::uint8_t> bytes) {
    StateReader state(bytes);
    std::int32_t number = 0;
    bool yes = false;
    std::string text;
    Eigen::Isometry3d T;
    std::optional<Eigen::Vector2d> none, some;
    std::vector<float> values;
    const bool got = state.Get(number) && state.Get(yes) && state.Get(text) && state.Get(T) &&
                     state.Get(none) && state.Get(some) && state.GetArray(values) && state.at_end();
    return got && number == -7 && yes && text == "a word" && T.translation().y() == 2 && !none &&
           some->y() == 5 && values == std::vector<float>{1.5f, -2.5f};
}

TEST(StateStream, GivesBackWhatWasPut) { EXPECT_TRUE(GetEverything(Everything())); }

TEST(StateStream, EveryCutIsFoundAndSoIsARest) {
    std::vector<std::uint8_t> bytes = Everything();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(GetEverything(std::span(bytes).first(size))) << size;
    bytes.push_back(0);
    EXPECT_FALSE(GetEverything(bytes));
}

TEST(StateStream, AListOfFieldsIsItsFieldsOneByOne) {
    const std::int32_t number = -7;
    const double share = 0.5;
    const std::vector<std::uint16_t> values{3, 4, 5};
    std::vector<std::uint8_t> bytes;
    StateWriter state(bytes);
    state.Put(number);
    state.Put(share);
    state.PutArray(std::span<const std::uint16_t>(values));
    EXPECT_EQ(Encoded(std::tie(number, share, values)), bytes);
    std::int32_t got_number = 0;
    double got_share = 0;
    std::vector<std::uint16_t> got_values;
    const auto fields = std::tie(got_number, got_share, got_values);
    StateReader reader(bytes);
    EXPECT_TRUE(reader.Get(fields) && reader.at_end());
    EXPECT_EQ(fields, std::tie(number, share, values));
    EXPECT_TRUE(AllFinite(fields));
    got_share = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(AllFinite(fields));
    EXPECT_FALSE(StateReader(std::span(bytes).first(9)).Get(fields));
}

TEST(StateStream, CountsBeyondTheBytesAllocateNothing) {
    std::vector<std::uint8_t> bytes;
    StateWriter(bytes).Put(std::numeric_limits<std::uint64_t>::max());
    std::vector<double> values;
    EXPECT_FALSE(StateReader(bytes).GetArray(values));
    EXPECT_EQ(values.capacity(), 0u);
}

TEST(StateStream, WhatIsNoPoseIsRefused) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    const auto goes_through = [&] {
        std::vector<std::uint8_t> bytes;
        StateWriter(bytes).Put(T);
        Eigen::Isometry3d got;
        return StateReader(bytes).Get(got);
    };
    EXPECT_TRUE(goes_through());
    T.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(goes_through());
    T.translation().x() = 0;
    T.linear() *= 2;
    EXPECT_FALSE(goes_through());
    T.linear() = -Eigen::Matrix3d::Identity();  // a reflection
    EXPECT_FALSE(goes_through());
}

}  // namespace
}  // namespace tessera
