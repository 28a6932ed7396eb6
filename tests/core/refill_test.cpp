#include "core/refill.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Refill, KeepsStorageUnlessALargeOneIsMostlyEmpty) {
    std::vector<double> values;
    Refill(1 << 20, values);
    EXPECT_EQ(values.capacity(), std::size_t{1} << 20);  // exact
    const double* storage = values.data();
    Refill(1 << 19, values);
    EXPECT_EQ(values.data(), storage);
    EXPECT_EQ(values.size(), std::size_t{1} << 19);
    Refill(1000, values);
    EXPECT_EQ(values.capacity(), 1000u);
    storage = values.data();
    Refill(1, values);  // small ones are kept
    EXPECT_EQ(values.data(), storage);
}

}  // namespace
}  // namespace tessera
