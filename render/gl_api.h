// SPDX-License-Identifier: BSD-3-Clause
// The OpenGL functions that are used, fetched at run time: the program itself needs no GL library
// to start, so a machine without one can still simulate. Include in .cpp files only.
#pragma once

#define GL_GLEXT_PROTOTYPES 0
#include <GL/glcorearb.h>

namespace cprsim {

// clang-format off
#define CPRSIM_GL_FUNCTIONS(X) \
  X(ActiveTexture, ACTIVETEXTURE) X(AttachShader, ATTACHSHADER) \
  X(BindBuffer, BINDBUFFER) X(BindFramebuffer, BINDFRAMEBUFFER) X(BindSampler, BINDSAMPLER) \
  X(BindTexture, BINDTEXTURE) X(BindVertexArray, BINDVERTEXARRAY) \
  X(BlendFuncSeparate, BLENDFUNCSEPARATE) X(BlitFramebuffer, BLITFRAMEBUFFER) \
  X(BufferData, BUFFERDATA) X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS) \
  X(Clear, CLEAR) X(ClearColor, CLEARCOLOR) X(ColorMask, COLORMASK) \
  X(CompileShader, COMPILESHADER) X(CreateProgram, CREATEPROGRAM) \
  X(CreateShader, CREATESHADER) X(CullFace, CULLFACE) \
  X(DeleteBuffers, DELETEBUFFERS) X(DeleteFramebuffers, DELETEFRAMEBUFFERS) \
  X(DeleteProgram, DELETEPROGRAM) X(DeleteShader, DELETESHADER) \
  X(DeleteSamplers, DELETESAMPLERS) X(DeleteTextures, DELETETEXTURES) X(DeleteVertexArrays, DELETEVERTEXARRAYS) \
  X(DepthFunc, DEPTHFUNC) X(DepthMask, DEPTHMASK) X(Disable, DISABLE) \
  X(DrawArrays, DRAWARRAYS) X(DrawBuffers, DRAWBUFFERS) X(DrawElements, DRAWELEMENTS) \
  X(Enable, ENABLE) X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
  X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D) X(GenBuffers, GENBUFFERS) \
  X(GenFramebuffers, GENFRAMEBUFFERS) X(GenSamplers, GENSAMPLERS) X(GenTextures, GENTEXTURES) \
  X(GenVertexArrays, GENVERTEXARRAYS) X(GenerateMipmap, GENERATEMIPMAP) X(GetError, GETERROR) X(GetIntegerv, GETINTEGERV) \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG) X(GetProgramiv, GETPROGRAMIV) \
  X(GetShaderInfoLog, GETSHADERINFOLOG) X(GetShaderiv, GETSHADERIV) X(GetString, GETSTRING) \
  X(GetUniformLocation, GETUNIFORMLOCATION) X(LinkProgram, LINKPROGRAM) \
  X(PixelStorei, PIXELSTOREI) X(PolygonOffset, POLYGONOFFSET) X(ReadPixels, READPIXELS) \
  X(SamplerParameteri, SAMPLERPARAMETERI) X(Scissor, SCISSOR) X(ShaderSource, SHADERSOURCE) X(TexImage2D, TEXIMAGE2D) \
  X(TexImage2DMultisample, TEXIMAGE2DMULTISAMPLE) X(TexParameterfv, TEXPARAMETERFV) \
  X(TexParameteri, TEXPARAMETERI) X(Uniform1f, UNIFORM1F) X(Uniform1i, UNIFORM1I) \
  X(Uniform2f, UNIFORM2F) X(Uniform3fv, UNIFORM3FV) X(Uniform4fv, UNIFORM4FV) \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV) X(UseProgram, USEPROGRAM) \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER) X(Viewport, VIEWPORT)

// clang-format on

/// gl.Clear(...) is glClear(...), and so on.
struct Gl {
#define CPRSIM_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  CPRSIM_GL_FUNCTIONS(CPRSIM_GL_MEMBER)
#undef CPRSIM_GL_MEMBER
};

}  // namespace cprsim
