#include "core/status.h"

#include <gtest/gtest.h>

#include <memory>

namespace tessera {
namespace {

TEST(Status, IsOkUntilToldOtherwise) {
    EXPECT_TRUE(Status().ok());
    EXPECT_TRUE(Status::Ok().ok());
    EXPECT_EQ(Status::Ok().message(), "");
    const Status error = Status::Error("a.yaml: bad");
    EXPECT_FALSE(error.ok());
    EXPECT_EQ(error.message(), "a.yaml: bad");
    EXPECT_FALSE(Status::Error("").ok());  // an error without text is still an error
}

TEST(Result, HoldsAValueOrTheReason) {
    Result<int> good = 5;
    EXPECT_TRUE(good.ok());
    EXPECT_TRUE(good.status().ok());
    EXPECT_EQ(good.value(), 5);
    good.value() = 6;
    EXPECT_EQ(std::as_const(good).value(), 6);
    const Result<int> bad = Status::Error("why");
    EXPECT_FALSE(bad.ok());
    EXPECT_EQ(bad.message(), "why");
}

TEST(Result, CarriesMoveOnlyValues) {
    Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
    EXPECT_EQ(*std::move(result.value()), 3);
}

TEST(ResultDeath, MisuseIsABug) {
    EXPECT_DEATH(Result<int>{Status::Ok()}, "needs an error");
    const Result<int> bad = Status::Error("no such file");
    EXPECT_DEATH((void)bad.value(), "no such file");
}

TEST(CheckDeath, NamesFileLineExpressionAndValues) {
    const int size = 3;
    EXPECT_DEATH(TESSERA_CHECK(size < 2, "size {}", size),
                 "status_test.cpp:[0-9]+: check failed: size < 2 \\(size 3\\)");
}

}  // namespace
}  // namespace tessera
