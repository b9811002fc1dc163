// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl_objects.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>

namespace cprsim {

namespace {

GLuint compile(const Gl& gl, GLenum stage, const std::string& source) {
  const GLuint shader = gl.CreateShader(stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint good = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::array<char, 2000> log{};
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteShader(shader);
  throw std::runtime_error(std::string("the OpenGL driver rejects a shader: ") + log.data());
}

}  // namespace

GlName::GlName(const Gl& gl, Kind kind) : gl_(&gl), kind_(kind) {
  switch (kind) {
    case Kind::kTexture:
      gl.GenTextures(1, &name_);
      break;
    case Kind::kFramebuffer:
      gl.GenFramebuffers(1, &name_);
      break;
    case Kind::kBuffer:
      gl.GenBuffers(1, &name_);
      break;
    case Kind::kVertexArray:
      gl.GenVertexArrays(1, &name_);
      break;
    case Kind::kSampler:
      gl.GenSamplers(1, &name_);
      break;
  }
}

GlName& GlName::operator=(GlName&& other) noexcept {
  std::swap(gl_, other.gl_);
  std::swap(kind_, other.kind_);
  std::swap(name_, other.name_);
  return *this;
}

GlName::~GlName() {
  if (gl_ == nullptr || name_ == 0) return;
  switch (kind_) {
    case Kind::kTexture:
      gl_->DeleteTextures(1, &name_);
      break;
    case Kind::kFramebuffer:
      gl_->DeleteFramebuffers(1, &name_);
      break;
    case Kind::kBuffer:
      gl_->DeleteBuffers(1, &name_);
      break;
    case Kind::kVertexArray:
      gl_->DeleteVertexArrays(1, &name_);
      break;
    case Kind::kSampler:
      gl_->DeleteSamplers(1, &name_);
      break;
  }
}

GlName make_texture(const Gl& gl, GLint format, int width, int height, int samples) {
  GlName texture(gl, GlName::Kind::kTexture);
  const bool depth = format == GL_DEPTH_COMPONENT24 || format == GL_DEPTH_COMPONENT16 ||
                     format == GL_DEPTH_COMPONENT32F;
  if (samples > 1) {
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
    gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, static_cast<GLenum>(format), width,
                             height, GL_TRUE);
    return texture;
  }
  const GLenum channels = depth ? GL_DEPTH_COMPONENT : format == GL_R32F ? GL_RED : GL_RGBA;
  const GLenum type = format == GL_RGBA8 ? GL_UNSIGNED_BYTE : GL_FLOAT;
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, channels, type, nullptr);
  for (const GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}}) {
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  }
  for (const GLenum wrap : {GLenum{GL_TEXTURE_WRAP_S}, GLenum{GL_TEXTURE_WRAP_T}}) {
    gl.TexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  }
  return texture;
}

GlName make_target(const Gl& gl, const std::vector<GLuint>& colors, GLuint depth, int samples) {
  GlName target(gl, GlName::Kind::kFramebuffer);
  const GLenum kind = samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  gl.BindFramebuffer(GL_FRAMEBUFFER, target);
  std::vector<GLenum> outputs;
  for (GLuint color : colors) {
    const GLenum slot = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size());
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, slot, kind, color, 0);
    outputs.push_back(slot);
  }
  if (outputs.empty()) outputs.push_back(GL_NONE);
  gl.DrawBuffers(static_cast<GLsizei>(outputs.size()), outputs.data());
  if (depth != 0) gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, kind, depth, 0);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(
        "this OpenGL cannot draw into the pictures that are needed (size or format)");
  }
  return target;
}

Program::Program(const Gl& gl, const std::string& vertex, const std::string& fragment) : gl_(gl) {
  const GLuint v = compile(gl, GL_VERTEX_SHADER, vertex);
  const GLuint f = compile(gl, GL_FRAGMENT_SHADER, fragment);
  name_ = gl.CreateProgram();
  gl.AttachShader(name_, v);
  gl.AttachShader(name_, f);
  gl.LinkProgram(name_);
  gl.DeleteShader(v);
  gl.DeleteShader(f);
  GLint good = 0;
  gl.GetProgramiv(name_, GL_LINK_STATUS, &good);
  if (good) return;
  std::array<char, 2000> log{};
  gl.GetProgramInfoLog(name_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  gl.DeleteProgram(name_);
  throw std::runtime_error(std::string("the OpenGL driver rejects a program: ") + log.data());
}

Program::~Program() {
  gl_.DeleteProgram(name_);
}

void Program::set(const char* name, int value) const {
  gl_.Uniform1i(at(name), value);
}

void Program::set(const char* name, double value) const {
  gl_.Uniform1f(at(name), static_cast<float>(value));
}

void Program::set(const char* name, const Vec2& value) const {
  gl_.Uniform2f(at(name), static_cast<float>(value.x()), static_cast<float>(value.y()));
}

void Program::set(const char* name, const Vec3& value) const {
  set(name, std::vector<Vec3>{value});
}

void Program::set(const char* name, const Vec4& value) const {
  set(name, std::vector<Vec4>{value});
}

void Program::set(const char* name, const Mat4& value) const {
  const Eigen::Matrix4f m = value.cast<float>();
  gl_.UniformMatrix4fv(at(name), 1, GL_FALSE, m.data());
}

void Program::set(const char* name, const std::vector<Vec3>& values) const {
  std::vector<Eigen::Vector3f> f;
  for (const Vec3& v : values)
    f.push_back(v.cast<float>());
  if (!f.empty()) gl_.Uniform3fv(at(name), static_cast<GLsizei>(f.size()), f.data()->data());
}

void Program::set(const char* name, const std::vector<Vec4>& values) const {
  std::vector<float> f;
  for (const Vec4& v : values) {
    for (int i = 0; i < 4; ++i)
      f.push_back(static_cast<float>(v[i]));
  }
  if (!f.empty()) gl_.Uniform4fv(at(name), static_cast<GLsizei>(values.size()), f.data());
}

Geometry::Geometry(const Gl& gl)
    : gl_(&gl),
      array_(gl, GlName::Kind::kVertexArray),
      vertices_(gl, GlName::Kind::kBuffer),
      indices_(gl, GlName::Kind::kBuffer) {
  gl.BindVertexArray(array_);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  const auto attribute = [&](GLuint slot, GLint size, GLenum type, GLboolean scaled,
                             std::size_t at) {
    gl.EnableVertexAttribArray(slot);
    gl.VertexAttribPointer(slot, size, type, scaled, sizeof(Vertex), reinterpret_cast<void*>(at));
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, position));
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(Vertex, normal));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Vertex, color));
  gl.BindVertexArray(0);
}

void Geometry::upload(const TriMesh& mesh) {
  const auto bytes = [](const auto& v) { return static_cast<GLsizeiptr>(v.size() * sizeof(v[0])); };
  gl_->BindVertexArray(array_);
  gl_->BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_->BufferData(GL_ARRAY_BUFFER, bytes(mesh.vertices), mesh.vertices.data(), GL_STREAM_DRAW);
  gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER, bytes(mesh.indices), mesh.indices.data(),
                  GL_STREAM_DRAW);
  count_ = static_cast<GLsizei>(mesh.indices.size());
}

void Geometry::draw() const {
  if (count_ == 0) return;
  gl_->BindVertexArray(array_);
  gl_->DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace cprsim
