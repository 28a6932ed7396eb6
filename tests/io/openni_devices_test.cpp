#include "io/openni_devices.h"

#include <gtest/gtest.h>

#include "io/temporary_folder.h"

namespace tessera {
namespace {

TEST(UsbCameras, AreKnownByTheirNumbers) {
    TemporaryFolder folder;
    const auto add = [&](const std::string& name, const char* vendor, const char* product,
                         const char* device) {
        folder.WriteText("sys/" + name + "/idVendor", std::string(vendor) + "\n");
        folder.WriteText("sys/" + name + "/idProduct", std::string(product) + "\n");
        folder.WriteText("sys/" + name + "/busnum", "1\n");
        folder.WriteText("sys/" + name + "/devnum", std::string(device) + "\n");
    };
    add("1-1", "1d6b", "0002", "1");  // a hub
    add("1-2", "1d27", "0601", "12");
    add("1-3", "045e", "02ae", "7");
    add("1-4", "045e", "0040", "8");  // a mouse
    folder.WriteText("sys/usb1/speed", "480\n");
    folder.WriteText("dev/001/012", "");
    const auto cameras = FindUsbCameras(folder.Path("sys"), folder.Path("dev"));
    ASSERT_EQ(cameras.size(), 2u);
    EXPECT_EQ(cameras[0].name, "Microsoft Kinect (Xbox 360)");
    EXPECT_EQ(cameras[0].path, folder.Path("dev/001/007"));
    EXPECT_FALSE(cameras[0].writable);  // no such file
    EXPECT_TRUE(cameras[0].needs_freenect);
    EXPECT_EQ(cameras[1].path, folder.Path("dev/001/012"));
    EXPECT_TRUE(cameras[1].writable);
    EXPECT_FALSE(cameras[1].needs_freenect);
    EXPECT_TRUE(FindUsbCameras("/no/such/folder", "/dev/bus/usb").empty());
}

}  // namespace
}  // namespace tessera
