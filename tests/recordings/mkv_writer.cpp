#include "recordings/mkv_writer.h"

#include <fmt/format.h>

#include <cstdlib>

#include "io/jpeg_encoder.h"

namespace tessera {
namespace {

std::string MkvTestDepthBytes(int index) {
    std::string bytes;
    const Image<std::uint16_t> depth = MkvTestDepth(index);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        bytes += static_cast<char>(depth.data()[i] >> 8);
        bytes += static_cast<char>(depth.data()[i] & 0xff);
    }
    return bytes;
}

// ffmpeg writes raw video only as the format 0. Azure Kinect recordings have "b16g" there.
void SetMkvDepthFormat(std::string& file) {
    std::string header{40, 0, 0, 0};  // BITMAPINFOHEADER: its size and the image's width
    for (const int byte : {kMkvDepthWidth % 256, kMkvDepthWidth / 256, 0, 0})
        header += static_cast<char>(byte);
    const std::size_t at = file.find(header);
    ASSERT_NE(at, std::string::npos);
    file.replace(at + 16, 4, "b16g");
}

}  // namespace

bool HaveFfmpeg() { return std::system("command -v ffmpeg >/dev/null 2>&1") == 0; }

Image<std::uint16_t> MkvTestDepth(int index) {
    Image<std::uint16_t> depth(kMkvDepthWidth, kMkvDepthHeight);
    for (int y = 0; y < depth.height(); ++y)
        for (int x = 0; x < depth.width(); ++x)
            depth(x, y) = static_cast<std::uint16_t>(500 + 1000 * index + 3 * x + 7 * y);
    return depth;
}

std::vector<std::uint8_t> MkvTestJpeg(int index) {
    ColourImage image(kMkvColourWidth, kMkvColourHeight,
                      {static_cast<std::uint8_t>(40 * index), 200, 30});
    for (int y = 100; y < 300; ++y)
        for (int x = 200; x < 600; ++x) image(x, y) = {static_cast<std::uint8_t>(x), 0, 90};
    std::vector<std::uint8_t> file;
    EXPECT_TRUE(EncodeJpeg(image, 90, file).ok());
    return file;
}

void WriteMkv(const TemporaryFolder& folder, const std::string& name, const MkvRecipe& recipe) {
    std::string inputs, outputs, depth, colour;
    const auto fps = fmt::format("-r {}", 1000 / kMkvFrame_ms);
    for (int i = 0; i < recipe.depth_count; ++i) depth += MkvTestDepthBytes(i);
    for (int i = 0; i < recipe.colour_count; ++i)
        for (const std::uint8_t byte : MkvTestJpeg(i)) colour += static_cast<char>(byte);
    int track = 0;
    if (recipe.colour_count > 0) {
        folder.WriteText("colour.mjpeg", colour);
        inputs +=
            fmt::format(" -itsoffset {}ms -f mjpeg {} -i colour.mjpeg", recipe.colour_late_ms, fps);
        outputs +=
            fmt::format(" -map {0} -metadata:s:v:{0} title={1}", track++, recipe.colour_name);
    }
    if (recipe.depth_count > 0) {
        folder.WriteText("depth.raw", depth);
        inputs +=
            fmt::format(" -itsoffset 0 -f rawvideo -pix_fmt gray16be -s {}x{} {} -i depth.raw",
                        kMkvDepthWidth, kMkvDepthHeight, fps);
        outputs += fmt::format(" -map {0} -metadata:s:v:{0} title={1}", track++, recipe.depth_name);
    }
    for (const std::string& tag : recipe.tags) outputs += " -metadata " + tag;
    if (!recipe.calibration.empty()) {
        folder.WriteText("calibration.json", recipe.calibration);
        outputs += " -attach calibration.json -metadata:s:t mimetype=application/octet-stream";
    }
    const std::string command = fmt::format(
        "cd '{}' && ffmpeg -nostdin -v error -y{}{} -c:v copy -allow_raw_vfw 1 -f matroska {}",
        folder.path(), inputs, outputs, recipe.streamed ? "- > " + name : name);
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    std::string file = ReadText(folder.Path(name));
    if (recipe.depth_count > 0) SetMkvDepthFormat(file);
    folder.WriteText(name, file);
}

}  // namespace tessera
