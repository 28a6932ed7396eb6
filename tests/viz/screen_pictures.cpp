// Makes pictures of the start screen, of a run's time line and of measurements (for
// synthetic:desk), for docs/images and to look at. Needs Xvfb. In a folder that holds the recording
// RECORDING and its run RUN:
//   screen_pictures PREFIX 1280x720 RECORDING RUN
// writes PREFIXstart.png, PREFIXcamera.png, PREFIXscene.png, PREFIXerror.png, PREFIXtime_line.png
// and PREFIXmeasure.png.
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "io/image_io.h"
#include "io/mesh_io.h"
#include "run/examine_path.h"
#include "run/open_source.h"
#include "run/scanned.h"
#include "viz/start_screen.h"
#include "viz/virtual_display.h"

namespace tessera {
namespace {

struct Arguments {
    std::string prefix, size, recording, run;
    int width = 1280, height = 720;
};

using Find = std::function<std::optional<ControlRect>(const std::string&)>;
using Round = std::function<bool()>;

void Rounds(const Round& round, int n) {
    for (int i = 0; i < n; ++i) static_cast<void>(round());
}

void Click(testing_support::VirtualDisplay& display, const Find& find, const Round& round,
           const std::string& name, float along = 0.5f) {
    const auto rect = find(name);
    if (!rect) {
        std::fprintf(stderr, "no control %s\n", name.c_str());
        return;
    }
    display.MoveTo(rect->x + along * rect->width, rect->y + rect->height / 2);
    Rounds(round, 4);
    display.Press(1);
    Rounds(round, 3);
    display.Release(1);
    Rounds(round, 10);
}

Status StartPictures(const Arguments& a, testing_support::VirtualDisplay& display) {
    StartServices services;
    services.examine = [](const std::string& path) {
        const ExaminedPath found = ExaminePath(path, RunConfig());
        return PathFinding{found.can_run, found.can_view, found.failed, found.text};
    };
    services.list_cameras = ListOpenniDevices;
    auto screen = StartScreen::Open(services, {.width = a.width, .height = a.height});
    if (!screen.ok()) return screen.status();
    const Find find = [&](const std::string& name) { return screen.value()->FindControl(name); };
    const Round round = [&] { return screen.value()->RunOnce(); };
    const auto click = [&](const std::string& name) { Click(display, find, round, name); };
    const auto save = [&](const std::string& name) {
        Rounds(round, 60);  // what threads look up has come
        return WriteColourImage(a.prefix + name, screen.value()->Picture());
    };
    Rounds(round, 5);
    click("entry." + a.recording);
    Status status = save("start.png");
    click("page.camera");
    if (status.ok()) status = save("camera.png");
    click("page.demo");
    click("quality.fine");
    click("loops");
    if (status.ok()) status = save("scene.png");
    screen.value()->Refuse(
        "/data/scans/desk/camera.yaml: fx: is missing; the keys are width, "
        "height, fx, fy, cx, cy, distortion, depth_scale, fps");
    if (status.ok()) status = save("error.png");
    return status;
}

Status TimeLinePicture(const Arguments& a, testing_support::VirtualDisplay& display) {
    Result<Scanned> run = ReadRunFolder(a.run);
    if (!run.ok()) return run.status();
    ViewedModel model;
    model.mesh = std::move(run.value().mesh);
    for (const StampedPose& pose : run.value().path) model.path.push_back(pose.T_world_camera);
    model.time_line = ReadTimeLine(a.run);
    if (!model.time_line) return Status::Error(a.run + ": has no time line");
    model.open_source = [&] { return OpenSource(a.recording, RunConfig()); };
    ViewerOptions options;
    options.screen.width = a.width;
    options.screen.height = a.height;
    if (model.time_line->run.camera) options.camera = *model.time_line->run.camera;
    auto viewer = Viewer::OpenModel(std::move(model), options);
    if (!viewer.ok()) return viewer.status();
    const Find find = [&](const std::string& name) { return viewer.value()->FindControl(name); };
    const Round round = [&] { return viewer.value()->RunOnce(); };
    Rounds(round, 5);
    Click(display, find, round, "time_line", 0.62f);
    display.MoveTo(static_cast<float>(a.width) / 2, 100);
    for (int i = 0; i < 200 && !find("camera_image"); ++i) round();
    Rounds(round, 10);
    const Status status = WriteColourImage(a.prefix + "time_line.png", viewer.value()->Picture());
    if (!status.ok()) return status;
    Click(display, find, round, "measure");
    const auto click_at = [&](float x, float y) {  // of 1280x720
        display.MoveTo(x * static_cast<float>(a.width) / 1280,
                       y * static_cast<float>(a.height) / 720);
        Rounds(round, 4);
        display.Press(1);
        Rounds(round, 3);
        display.Release(1);
        Rounds(round, 10);
    };
    for (const auto& [x, y] : {std::pair{470, 296}, {818, 388}})
        click_at(static_cast<float>(x), static_cast<float>(y));
    Click(display, find, round, "measure.new");
    for (const auto& [x, y] : {std::pair{545, 186}, {642, 192}, {639, 236}, {547, 232}, {545, 186}})
        click_at(static_cast<float>(x), static_cast<float>(y));
    return WriteColourImage(a.prefix + "measure.png", viewer.value()->Picture());
}

int MakePictures(Arguments a) {
    std::sscanf(a.size.c_str(), "%dx%d", &a.width, &a.height);
    std::string why;
    const auto display = testing_support::VirtualDisplay::Start(why, a.size);
    Status status = display ? StartPictures(a, *display) : Status::Error(why);
    if (status.ok()) status = TimeLinePicture(a, *display);
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
    return status.ok() ? 0 : 1;
}

}  // namespace
}  // namespace tessera

int main(int argc, char** argv) {
    return argc < 5 ? 2 : tessera::MakePictures({argv[1], argv[2], argv[3], argv[4]});
}
