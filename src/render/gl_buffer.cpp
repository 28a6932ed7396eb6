#include "render/gl_buffer.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace tessera {

GlBuffer::~GlBuffer() {
    if (name_) glDeleteBuffers(1, &name_);
}

bool GlBuffer::Reserve(std::size_t bytes) {
    if (bytes <= capacity_) return false;
    constexpr std::size_t kSmallest = std::size_t{1} << 20;
    const std::size_t capacity = std::max(bytes + bytes / 2, kSmallest);
    GLuint name = 0;
    glGenBuffers(1, &name);
    // Use the copy targets, so that no vertex array's binding changes.
    glBindBuffer(GL_COPY_WRITE_BUFFER, name);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(capacity), nullptr, GL_DYNAMIC_DRAW);
    if (name_) {
        glBindBuffer(GL_COPY_READ_BUFFER, name_);
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0,
                            static_cast<GLsizeiptr>(capacity_));
        glDeleteBuffers(1, &name_);
    }
    name_ = name;
    capacity_ = capacity;
    return true;
}

void GlBuffer::Write(std::size_t offset, const void* data, std::size_t bytes) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, name_);
    glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace tessera
