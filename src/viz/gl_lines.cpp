#include "viz/gl_lines.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace tessera {
namespace {

// Clips both ends at the near plane before the perspective division, so that a line that passes the
// viewer stays straight.
constexpr const char* kLineVertexSource = R"(#version 330 core
layout(location = 0) in vec3 start;
layout(location = 1) in vec4 start_colour;
layout(location = 2) in vec3 end;
layout(location = 3) in vec4 end_colour;
uniform mat4 clip_from_world;
uniform vec2 size_px;
uniform float width_px;
uniform float opacity;
out vec4 colour;

void main() {
    vec4 a = clip_from_world * vec4(start, 1), b = clip_from_world * vec4(end, 1);
    float near_a = a.z + a.w, near_b = b.z + b.w;
    if (near_a < 0 && near_b > 0) a = mix(a, b, near_a / (near_a - near_b));
    if (near_b < 0 && near_a > 0) b = mix(b, a, near_b / (near_b - near_a));
    vec2 along = (b.xy / b.w - a.xy / a.w) * size_px;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1, 0);
    float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0, cap = (gl_VertexID & 2) == 0 ? -0.3 : 0.3;
    vec4 here = (gl_VertexID & 2) == 0 ? a : b;
    vec2 offset = (vec2(-along.y, along.x) * side + along * cap) * width_px / size_px;
    gl_Position = here + vec4(offset * here.w, 0, 0);
    colour = (gl_VertexID & 2) == 0 ? start_colour : end_colour;
    colour.a = min(start_colour.a, end_colour.a) * opacity;
    if (colour.a == 0 || (near_a < 0 && near_b < 0)) gl_Position = vec4(0, 0, -2, 1);
}
)";

constexpr const char* kLineFragmentSource = R"(#version 330 core
in vec4 colour;
out vec4 pixel;
void main() { pixel = colour; }
)";

}  // namespace

GlLines::GlLines() { glGenVertexArrays(1, &vertex_array_); }

GlLines::~GlLines() { glDeleteVertexArrays(1, &vertex_array_); }

void GlLines::Append(std::span<const LineVertex> vertices) {
    buffer_.Reserve((count_ + vertices.size()) * sizeof(LineVertex));
    buffer_.Write(count_ * sizeof(LineVertex), vertices.data(), vertices.size_bytes());
    count_ += vertices.size();
}

// One instance per line. Its second end is the next vertex in the same buffer.
void GlLines::Bind(bool connected) {
    glBindVertexArray(vertex_array_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    const auto stride = static_cast<GLsizei>(sizeof(LineVertex) * (connected ? 1 : 2));
    for (GLuint end = 0; end < 2; ++end) {
        const std::size_t offset = end * sizeof(LineVertex);
        glVertexAttribPointer(2 * end, 3, GL_FLOAT, GL_FALSE, stride,
                              reinterpret_cast<const void*>(offset));
        glVertexAttribPointer(2 * end + 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                              reinterpret_cast<const void*>(offset + offsetof(LineVertex, colour)));
    }
    for (GLuint i = 0; i < 4; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribDivisor(i, 1);
    }
}

Result<GlLineProgram> GlLineProgram::Create() {
    Result<GlProgram> program = GlProgram::Create(kLineVertexSource, kLineFragmentSource);
    if (!program.ok()) return program.status();
    return GlLineProgram(std::move(program.value()));
}

void GlLineProgram::Draw(GlLines& lines, const View& view, bool connected, float width_px,
                         float opacity) const {
    const std::size_t count =
        connected ? std::max<std::size_t>(lines.size(), 1) - 1 : lines.size() / 2;
    if (count == 0) return;
    program_.Use();
    const Eigen::Matrix4f clip = view.clip_from_world.cast<float>();
    glUniformMatrix4fv(program_.Location("clip_from_world"), 1, GL_FALSE, clip.data());
    glUniform2f(program_.Location("size_px"), static_cast<float>(view.width_px),
                static_cast<float>(view.height_px));
    glUniform1f(program_.Location("width_px"), width_px);
    glUniform1f(program_.Location("opacity"), opacity);
    lines.Bind(connected);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
    glBindVertexArray(0);
}

}  // namespace tessera
