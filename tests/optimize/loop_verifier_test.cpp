#include "optimize/loop_verifier.h"

#include <gtest/gtest.h>

#include <random>

namespace tessera {
namespace {

// Two keyframes 100 m of path apart that see the same features. The graph has the new one `off_m`
// from where the features have it.
LoopVerifier::Match MatchOf(double off_m) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<float> metres(-1, 1);
    Keyframe old, fresh;
    for (int i = 0; i < 60; ++i) {
        old.features.p_camera.emplace_back(metres(random), metres(random), 2 + metres(random));
        old.features.descriptors.push_back({random(), random(), random(), random()});
    }
    fresh.features = old.features;
    fresh.path_length_m = 100;
    fresh.T_world_camera.translation().x() = off_m;
    return LoopVerifier({}, {}).MatchKeyframes(old, fresh);
}

// Doors and racks of a corridor look alike, and their drift is possible on a long way.
TEST(LoopVerifier, LargeDriftNeedsTheSameTexture) {
    const LoopVerifier::Match near = MatchOf(0.1), far = MatchOf(2.0), beyond = MatchOf(9.0);
    ASSERT_TRUE(near.T_old_new);
    EXPECT_FALSE(near.ask_for_texture);
    ASSERT_TRUE(far.T_old_new);
    EXPECT_LT(far.T_old_new->translation().norm(), 0.01);
    EXPECT_TRUE(far.ask_for_texture);
    EXPECT_FALSE(beyond.T_old_new) << "no drift is that large";
}

}  // namespace
}  // namespace tessera
