#include "gl/objects.h"

#include <array>
#include <string>

#include "gl/device.h"

namespace radiosity::gl {

namespace {

/// `state`: of the shader or program; `log`: its first words.
template <class Log>
void require(GLint state, GLuint name, const Log& log) {
  if (state == GL_TRUE) return;
  std::array<char, 400> words{};
  log(name, GLsizei(words.size()), nullptr, words.data());
  throw Failure("the driver refuses a shader: " + std::string(words.data()));
}

}  // namespace

Program::Program(std::initializer_list<Stage> stages) : name_(glCreateProgram()) {
  GLint state = GL_FALSE;
  for (const Stage& stage : stages) {
    const GLuint shader = glCreateShader(stage.kind);
    glShaderSource(shader, GLsizei(stage.source.size()), stage.source.data(), nullptr);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &state);
    require(state, shader, glGetShaderInfoLog);
    glAttachShader(name_, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(name_);
  glGetProgramiv(name_, GL_LINK_STATUS, &state);
  require(state, name_, glGetProgramInfoLog);
}

void Program::useWith(std::initializer_list<const Buffer*> blocks) const {
  GLuint k = 0;
  for (const Buffer* block : blocks) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k++, block->name());
  }
  use();
}

}  // namespace radiosity::gl
