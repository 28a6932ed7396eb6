#include "scan/scan_records.h"

#include <gtest/gtest.h>

#include <limits>

#include "scan/small_scan.h"

namespace tessera {
namespace {

const PinholeCamera kRecordCamera{64, 48, 60, 60, 31.5, 23.5};

Keyframe SomeKeyframe() {
    Keyframe keyframe;
    keyframe.stamp_s = 4.5;
    keyframe.depth_m.Resize(4, 3);
    std::fill_n(keyframe.depth_m.data(), keyframe.depth_m.size(), 2.0f);
    keyframe.reduced.reduction = 2;
    keyframe.reduced.depth.Resize(32, 24);
    keyframe.reduced.luma.Resize(32, 24);
    for (int i = 0; i < 32 * 24; ++i) {
        keyframe.reduced.depth.data()[i] = static_cast<std::uint16_t>(37 * i);
        keyframe.reduced.luma.data()[i] = static_cast<std::uint8_t>(i);
    }
    keyframe.skew_m = 0.25;
    keyframe.skew_rad = 0.5;
    Overlap overlap;
    overlap.with = 3;
    overlap.T_with_this_aligned = Eigen::Translation3d(1, 2, 3);
    overlap.information = 7 * Matrix6d::Identity();
    keyframe.overlaps.push_back(overlap);
    overlap.T_with_this_tracked = Eigen::Isometry3d(Eigen::Translation3d(4, 5, 6));
    keyframe.overlaps.push_back(overlap);
    return keyframe;
}

// A scan of one band has the record that it had before bands grew.
TEST(ScanRecords, MetaKeepsTheBandsGrowth) {
    ScanMeta meta = testing_support::SmallMeta();
    const Bytes of_one_band = meta.Encode();
    meta.band_per_m = 0.0125;
    const Bytes bytes = meta.Encode();
    ScanMeta back;
    ASSERT_TRUE(back.Decode(bytes));
    EXPECT_EQ(back.band_per_m, 0.0125);
    EXPECT_EQ(back.truncation_m, meta.truncation_m);
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_EQ(back.Decode(std::span(bytes).first(size)), size == of_one_band.size()) << size;
    ASSERT_TRUE(back.Decode(of_one_band));
    EXPECT_EQ(back.band_per_m, 0);
    meta.band_per_m = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(back.Decode(meta.Encode()));
}

TEST(ScanRecords, AKeyframeComesBackWithItsViewAndOverlaps) {
    const Keyframe keyframe = SomeKeyframe();
    const Bytes bytes = EncodeKeyframe(keyframe);
    Keyframe back;
    ASSERT_TRUE(DecodeKeyframe(bytes, kRecordCamera, back));
    EXPECT_EQ(EncodeKeyframe(back), bytes);
    ASSERT_EQ(back.overlaps.size(), 2u);
    EXPECT_EQ(back.overlaps[0].with, 3);
    EXPECT_FALSE(back.overlaps[0].T_with_this_tracked.has_value());
    EXPECT_EQ(back.overlaps[1].T_with_this_tracked->translation().z(), 6);
    EXPECT_EQ(back.reduced.depth(1, 1), 37 * 33);
    EXPECT_EQ(back.skew_rad, 0.5);
}

// Cut off anywhere, it is refused, except where a keyframe of format 1 ended.
TEST(ScanRecords, AKeyframeThatIsCutOffOrTooLongIsRefused) {
    const Bytes bytes = EncodeKeyframe(SomeKeyframe());
    Bytes longer = bytes;
    longer.push_back(0);
    Keyframe none;
    EXPECT_FALSE(DecodeKeyframe(longer, kRecordCamera, none));
    int accepted = 0;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        Keyframe back;
        if (!DecodeKeyframe(std::span(bytes).first(size), kRecordCamera, back)) continue;
        ++accepted;
        EXPECT_TRUE(back.reduced.empty());
        EXPECT_TRUE(back.overlaps.empty());
    }
    EXPECT_EQ(accepted, 1);
}

// A frame of which no class was ignored has the record that it had before they were kept.
TEST(ScanRecords, AFrameComesBackWithItsIgnoredClasses) {
    FrameRecord record;
    record.stored.images = StoredImages({{1, 2, 3}, {4, 5}});
    const std::vector<Detection> detections{
        {"cup", 1, 0.9f, {1, 2, 3, 3}, Image<std::uint8_t>(3, 2, 1)}};
    record.stored.detections.emplace(detections);
    const Bytes of_none = record.Encode().value();
    record.stored.detections.emplace(detections, ClassSet().set(2).set(250));
    const Bytes bytes = record.Encode().value();
    EXPECT_EQ(bytes.size(), of_none.size() + 10);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        FrameRecord cut;
        EXPECT_EQ(cut.Decode(std::span(bytes).first(size)), size == of_none.size()) << size;
    }
    FrameRecord back;
    ASSERT_TRUE(back.Decode(bytes));
    EXPECT_EQ(back.stored.detections->ignored(), ClassSet().set(2).set(250));
    EXPECT_EQ(back.Encode().value(), bytes);
    ASSERT_TRUE(back.Decode(of_none));
    EXPECT_TRUE(back.stored.detections->ignored().none());
    ASSERT_EQ(back.stored.detections->Unpack().size(), 1u);
    EXPECT_TRUE(back.stored.detections->Unpack()[0].mask == detections[0].mask);
    Bytes wrong = bytes;
    wrong.back() = 251;
    EXPECT_FALSE(back.Decode(wrong));
}

TEST(ScanRecords, EdgesOfFormat1AreRead) {
    Bytes bytes;
    StateWriter state(bytes);
    state.Put(std::int64_t{9});
    state.Put(std::int32_t{2});
    state.Put(true);
    state.Put(std::uint64_t{1});
    state.Put(4);
    state.Put(5);
    state.Put(Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3)));
    state.Put(0.5);   // metres
    state.Put(0.25);  // radians
    state.Put(true);
    LoopProgress progress;
    ASSERT_TRUE(progress.Decode(bytes));
    ASSERT_EQ(progress.edges.size(), 1u);
    EXPECT_EQ(progress.edges[0].root_information, RootInformation(0.25, 0.5));
    const Bytes now = progress.Encode();
    LoopProgress again;
    ASSERT_TRUE(again.Decode(now));
    EXPECT_EQ(again.edges[0].root_information, progress.edges[0].root_information);
    EXPECT_EQ(again.edges[0].T_from_to.matrix(), progress.edges[0].T_from_to.matrix());
}

}  // namespace
}  // namespace tessera
