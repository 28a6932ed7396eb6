#include "viz/mesh_program.h"

#include <epoxy/gl.h>

#include "viz/colour_map.h"

namespace tessera {
namespace {

constexpr const char* kMeshVertexSource = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 normal;
layout(location = 2) in vec4 colour;
layout(location = 3) in vec4 mark;  // VertexMark
uniform mat4 clip_from_position;
uniform vec4 cut;  // plane in clip space
out vec3 normal_world;
out vec4 weighted_colour;
out vec4 marked;

void main() {
    gl_Position = clip_from_position * vec4(position, 1);
    gl_ClipDistance[0] = dot(cut, gl_Position);
    vec2 e = normal / 32767;
    vec3 n = vec3(e, 1 - abs(e.x) - abs(e.y));
    if (n.z < 0) n.xy = (1 - abs(e.yx)) * vec2(e.x < 0 ? -1 : 1, e.y < 0 ? -1 : 1);
    normal_world = normalize(n);
    weighted_colour = vec4(colour.rgb * colour.a, colour.a);
    marked = mark;
}
)";

// One lamp at the viewer's left shoulder and some light from the sky, so that bare walls still show
// their shape.
constexpr const char* kMeshFragmentSource = R"(#version 330 core
in vec3 normal_world;
in vec4 weighted_colour;
in vec4 marked;
uniform mat3 world_from_camera;
uniform vec4 intrinsics;  // fx, fy, cx, cy of OpenGL's pixel positions
uniform vec3 up;
uniform int shading;       // Shading's numbers
uniform vec3 weight_colours[5];
uniform vec2 coverage;  // CoverageLevels in [0, 1]
uniform vec3 once_colour, thin_colour;
out vec4 pixel;

vec3 weight_colour(float weight) {
    float at = clamp(weight, 0, 1) * 4;
    int stop = min(int(at), 3);
    return mix(weight_colours[stop], weight_colours[stop + 1], at - stop);
}

void main() {
    vec3 n = normal_world / max(length(normal_world), 1e-6);
    vec3 ray = vec3((gl_FragCoord.xy - intrinsics.zw) / intrinsics.xy, 1);
    vec3 to_lamp = world_from_camera * normalize(-normalize(ray) + vec3(-0.35, -0.45, 0));
    float lamp = max(dot(n, to_lamp), 0), sky = 0.5 + 0.5 * dot(n, up);
    vec3 grey = vec3(0.80, 0.81, 0.83) * (0.16 + 0.16 * sky) + vec3(0.60, 0.585, 0.56) * lamp;
    vec3 scene = grey;
    if (weighted_colour.a > 1e-3)
        scene = weighted_colour.rgb / weighted_colour.a * (0.6 + 0.1 * sky + 0.3 * lamp);  // at most 1: whites stay
    if (shading == 0) {
        pixel = vec4(scene, 1);
    } else if (shading == 5) {
        float missing = 1 - smoothstep(0.85 * coverage.y, coverage.y, marked.a);
        vec3 sign = mix(once_colour, thin_colour,
                        smoothstep(0.8 * coverage.x, 1.2 * coverage.x, marked.a));
        float bright = dot(scene, vec3(0.3, 0.6, 0.1));
        pixel = vec4(mix(scene, sign * (0.55 + 0.6 * bright), 0.8 * missing), 1);
    } else if (shading == 1) {
        pixel = vec4(marked.rgb * (0.5 + 0.14 * sky + 0.42 * lamp), 1);
    } else if (shading == 2) {
        pixel = vec4(weight_colour(marked.a) * (0.62 + 0.12 * sky + 0.34 * lamp), 1);
    } else if (shading == 4) {
        pixel = vec4((0.5 + 0.5 * n) * (0.72 + 0.34 * lamp), 1);
    } else {
        pixel = vec4(grey, 1);
    }
}
)";

}  // namespace

Result<MeshProgram> MeshProgram::Create() {
    Result<GlProgram> program = GlProgram::Create(kMeshVertexSource, kMeshFragmentSource);
    if (!program.ok()) return program.status();
    return MeshProgram(std::move(program.value()));
}

void MeshProgram::Use(const PinholeCamera& camera, const Eigen::Isometry3d& T_world_camera,
                      const Eigen::Vector3d& up, const Look& look) const {
    program_.Use();
    const Eigen::Matrix3f rotation = T_world_camera.linear().cast<float>();
    const Eigen::Vector3f up_world = up.cast<float>();
    glUniformMatrix3fv(program_.Location("world_from_camera"), 1, GL_FALSE, rotation.data());
    glUniform4f(program_.Location("intrinsics"), static_cast<float>(camera.fx),
                static_cast<float>(camera.fy), static_cast<float>(camera.cx + 0.5),
                static_cast<float>(camera.cy + 0.5));
    glUniform3fv(program_.Location("up"), 1, up_world.data());
    const Eigen::Vector4f cut = look.cut_in_clip_space.cast<float>();
    glUniform4fv(program_.Location("cut"), 1, cut.data());
    glUniform1i(program_.Location("shading"), static_cast<int>(look.shading));
    glUniform2f(program_.Location("coverage"), static_cast<float>(look.levels.once) / 255,
                static_cast<float>(look.levels.well) / 255);
    const auto set_colour = [&](const char* name, const Rgb8& c) {
        glUniform3f(program_.Location(name), static_cast<float>(c.r) / 255,
                    static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255);
    };
    set_colour("once_colour", kOnceColour);
    set_colour("thin_colour", kThinColour);
    static_assert(kWeightStops == 5, "size of the shader's array");
    std::array<float, 3 * kWeightStops> stops;
    for (std::size_t i = 0; i < kWeightColours.size(); ++i) {
        const Rgb8& c = kWeightColours[i];
        stops[3 * i] = static_cast<float>(c.r) / 255;
        stops[3 * i + 1] = static_cast<float>(c.g) / 255;
        stops[3 * i + 2] = static_cast<float>(c.b) / 255;
    }
    glUniform3fv(program_.Location("weight_colours"), kWeightStops, stops.data());
}

}  // namespace tessera
