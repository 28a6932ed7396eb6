#include "render/gl_program.h"

#include <epoxy/gl.h>

#include <array>

namespace tessera {
namespace {

std::string FirstLine(const char* log) {
    const std::string text = log;
    return text.substr(0, text.find('\n'));
}

Status AttachShader(GLuint program, GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    std::array<char, 512> log{};
    if (!compiled) glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    glAttachShader(program, shader);
    glDeleteShader(shader);  // the program keeps it alive
    return compiled ? Status::Ok()
                    : Status::Error("shader compilation failed: " + FirstLine(log.data()));
}

}  // namespace

Result<GlProgram> GlProgram::Create(const char* vertex_source, const char* fragment_source) {
    GlProgram program(glCreateProgram());
    for (const auto& [kind, source] : {std::pair(GL_VERTEX_SHADER, vertex_source),
                                       std::pair(GL_FRAGMENT_SHADER, fragment_source)})
        if (const Status status = AttachShader(program.name_, static_cast<GLenum>(kind), source);
            !status.ok())
            return status;
    glLinkProgram(program.name_);
    GLint linked = 0;
    glGetProgramiv(program.name_, GL_LINK_STATUS, &linked);
    if (linked) return program;
    std::array<char, 512> log{};
    glGetProgramInfoLog(program.name_, log.size(), nullptr, log.data());
    return Status::Error("shader linking failed: " + FirstLine(log.data()));
}

GlProgram::~GlProgram() {
    if (name_) glDeleteProgram(name_);
}

void GlProgram::Use() const { glUseProgram(name_); }

int GlProgram::Location(const char* uniform) const {
    const int location = glGetUniformLocation(name_, uniform);
    TESSERA_CHECK(location >= 0, "the program does not use {}", uniform);
    return location;
}

}  // namespace tessera
