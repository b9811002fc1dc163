// SPDX-License-Identifier: BSD-3-Clause
#include "render/gl_painter.h"

#include <algorithm>
#include <cmath>

#include "render/gl_textures.h"
#include "render/shaders/shaders.h"
#include "render/sweep.h"

namespace cprsim {

namespace {

constexpr double kShadowSoftness =
    0.02;  // widest half shadow, as a fraction of the shadow map's edge
constexpr double kShadowOffsetTexels =
    1.6;  // below 1.2 round rods show stripes of their own shadow

const char* const kOtherLights = "#define OTHER_LIGHTS\n";

// texture units
constexpr GLuint kObjects = 0, kShadowMap = 1, kShadowCover = 2, kFirst = 3, kSecond = 4,
                 kThird = 5;

std::string fragment(const char* source, const std::string& defines = "") {
  return std::string(shaders::kVersion) + defines + shaders::kLighting + source;
}

}  // namespace

GlPainter::GlPainter(const Gl& gl, int width, int height, int shadow_size, bool other_lights,
                     const std::vector<Part>& parts)
    : gl_(gl),
      width_(width),
      height_(height),
      shadow_size_(shadow_size),
      other_lights_(other_lights),
      parts_(parts),
      textures_(std::make_unique<GlTextures>(gl, width, height, shadow_size)),
      tubes_(gl),
      tube_shadows_(gl),
      ribbons_(gl),
      tiles_(gl) {
  const std::string version = shaders::kVersion;
  objects_ = std::make_unique<Program>(
      gl, version + shaders::kObjectVertex,
      fragment(shaders::kObjectFragment, other_lights ? kOtherLights : ""));
  shadows_ = std::make_unique<Program>(gl, version + shaders::kShadowVertex,
                                       version + shaders::kShadowFragment);
  for (const Part& part : parts) {
    geometries_.emplace_back(gl);
    geometries_.back().upload(part.mesh);
  }
}

GlPainter::~GlPainter() = default;

double GlPainter::softness() {
  return kShadowSoftness;
}

Mat4 GlPainter::light_clip(const Frame& frame) const {
  return light_projection(-frame.light.to_key, frame.shadow_ball.centre, frame.shadow_ball.radius);
}

void GlPainter::paint(const Frame& frame, const Changes& changes) {
  const Shine shine{true, frame.light.shadows, Which::kAll};
  upload_sweeps(frame);
  if (frame.light.shadows) draw_shadows(frame, Which::kAll);
  if (!changes.objects.empty()) draw_objects(frame, Which::kAll, changes.objects, shine);
  compose(Ground::kDirect, frame, textures_->to_picture, shine, changes.runs);
}

void GlPainter::store_still(const Frame& frame) {
  const Shine shine{true, frame.light.shadows, Which::kStill}, shade{false, false, Which::kStill};
  if (frame.light.shadows) draw_shadows(frame, Which::kStill);
  draw_objects(frame, Which::kStill, whole(), shine);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->to_objects);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, textures_->to_kept_depth);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_DEPTH_BUFFER_BIT,
                      GL_NEAREST);
  compose(Ground::kRanged, frame, textures_->to_in_light, shine,
          {{whole(), true, shine.shadows, true, true}});
  draw_objects(frame, Which::kStill, whole(), shade);
  compose(Ground::kDirect, frame, textures_->to_in_shade, shade,
          {{whole(), true, false, true, true}});
}

void GlPainter::paint_moving(const Frame& frame, const Changes& changes) {
  if (changes.runs.empty()) return;
  const Shine shine{true, frame.light.shadows, Which::kMoving};
  upload_sweeps(frame);
  if (frame.light.shadows) draw_shadows(frame, Which::kMoving);
  if (!changes.objects.empty()) draw_objects(frame, Which::kMoving, changes.objects, shine);
  compose(Ground::kCached, frame, textures_->to_picture, shine, changes.runs);
}

bool GlPainter::upload_tiles(const std::vector<TileRun>& runs, const TileRun& kind) {
  TriMesh mesh;
  for (const TileRun& run : runs) {
    if (!alike(run, kind)) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Region& r = run.region;
    for (const auto& [x, y] : {std::pair{r.x0, r.y0}, {r.x1, r.y0}, {r.x1, r.y1}, {r.x0, r.y1}}) {
      const Vec3 clip(2.0 * x / width_ - 1, 2.0 * y / height_ - 1, 0);
      mesh.vertices.push_back({clip.cast<float>(), Eigen::Vector3f::Zero(), {}});
    }
    mesh.indices.insert(mesh.indices.end(),
                        {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  tiles_.upload(mesh);
  return !mesh.indices.empty();
}

void GlPainter::upload_sweeps(const Frame& frame) {
  TriMesh mesh, shadows;
  for (const Tube& tube : frame.drawing.tubes) {
    sweep_tube(tube, frame.view, mesh);
    sweep_shadow(tube, frame.light.to_key, shadows);
  }
  tubes_.upload(mesh);
  tube_shadows_.upload(shadows);
  mesh = {};
  for (const Ribbon& ribbon : frame.drawing.ribbons)
    sweep_ribbon(ribbon, frame.view, mesh);
  ribbons_.upload(mesh);
}

bool GlPainter::drawn(std::size_t part, Which which) const {
  if (parts_[part].is_ground) return false;
  // glass is drawn with what moves: what shines through it may be moving
  const bool moving = parts_[part].moves || parts_[part].look.opacity < 1;
  return which == Which::kAll || (which == Which::kMoving) == moving;
}

void GlPainter::draw_shadows(const Frame& frame, Which which) {
  const bool on_top = which == Which::kMoving;
  const GlTextures::Shadow& shadow = which == Which::kStill ? textures_->still : textures_->moving;
  gl_.Disable(GL_SCISSOR_TEST);
  if (on_top) {
    // depths of what stands still, but not its cover: that is in the stored picture
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->still.target);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, shadow.target);
    gl_.BlitFramebuffer(0, 0, shadow_size_, shadow_size_, 0, 0, shadow_size_, shadow_size_,
                        GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, shadow.target);
  gl_.Viewport(0, 0, shadow_size_, shadow_size_);
  gl_.Disable(GL_BLEND);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(on_top ? GL_COLOR_BUFFER_BIT : GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.PolygonOffset(1.5F, 2.0F);
  shadows_->use();
  shadows_->set("clip_from_world", light_clip(frame));
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!drawn(i, which) || !parts_[i].casts_shadow || parts_[i].look.opacity < 0.5) continue;
    shadows_->set("world_from_object", to_matrix(frame.drawing.part_poses[i]));
    geometries_[i].draw();
  }
  if (which != Which::kStill) {
    shadows_->set("world_from_object", Mat4(Mat4::Identity()));
    tube_shadows_.draw();
  }
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, shadow.cover);
  gl_.GenerateMipmap(GL_TEXTURE_2D);
}

void GlPainter::draw_part(const Frame& frame, std::size_t i) const {
  const Look& look = parts_[i].look;
  objects_->set("world_from_object", to_matrix(frame.drawing.part_poses[i]));
  objects_->set("specular", look.specular);
  objects_->set("emissive", look.emissive);
  objects_->set("shininess", std::clamp(look.shininess, 1.0, 200.0));
  // the far side of a closed shape is never seen, unless through its near side
  if (parts_[i].closed && look.opacity >= 1) gl_.Enable(GL_CULL_FACE);
  geometries_[i].draw();
  gl_.Disable(GL_CULL_FACE);
}

void GlPainter::draw_objects(const Frame& frame, Which which, const Region& region,
                             const Shine& shine) {
  limit(region);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.DepthMask(GL_TRUE);
  if (which == Which::kMoving) {
    // what does not move is already there, as depth
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->to_kept_depth);
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, textures_->to_objects);
    gl_.BlitFramebuffer(region.x0, region.y0, region.x1, region.y1, region.x0, region.y0, region.x1,
                        region.y1, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
  gl_.BindFramebuffer(GL_FRAMEBUFFER, textures_->to_objects);
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(which == Which::kMoving ? GL_COLOR_BUFFER_BIT
                                    : GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const bool cut = frame.view.eye.z() > frame.backdrop.ground_z;
  if (cut) gl_.Enable(GL_CLIP_DISTANCE0);
  objects_->use();
  set_lighting(*objects_, frame, shine);
  objects_->set("clip_from_world", frame.view.projection());
  objects_->set("cut", Vec4(0, 0, 1, -frame.backdrop.ground_z));
  objects_->set("unlit", 0.0);
  objects_->set("self_lit", 0.0);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (drawn(i, which) && parts_[i].look.opacity >= 1) draw_part(frame, i);
  }
  if (which != Which::kStill) draw_sweeps_and_glass(frame, which);
  gl_.Disable(GL_CLIP_DISTANCE0);
}

void GlPainter::draw_sweeps_and_glass(const Frame& frame, Which which) {
  const Look look = frame.drawing.tubes.empty() ? Look{} : frame.drawing.tubes.front().look;
  objects_->set("world_from_object", Mat4(Mat4::Identity()));
  objects_->set("specular", look.specular);
  objects_->set("emissive", look.emissive);
  objects_->set("shininess", std::clamp(look.shininess, 1.0, 200.0));
  // colours that stand for numbers must not drown in shade
  objects_->set("self_lit", frame.drawing.tubes_mean_numbers ? 0.6 : 0.15);
  gl_.Enable(GL_CULL_FACE);
  tubes_.draw();
  gl_.Disable(GL_CULL_FACE);
  objects_->set("self_lit", 0.0);

  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl_.DepthMask(GL_FALSE);
  objects_->set("unlit", 1.0);
  ribbons_.draw();
  objects_->set("unlit", 0.0);
  // the farthest first
  std::vector<std::pair<double, std::size_t>> glass;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!drawn(i, which) || parts_[i].look.opacity >= 1) continue;
    glass.emplace_back(-(frame.drawing.part_poses[i].p - frame.view.eye).norm(), i);
  }
  std::sort(glass.begin(), glass.end());
  for (const auto& [distance, i] : glass)
    draw_part(frame, i);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

const Program& GlPainter::program_for(Ground ground, const TileRun& kind) {
  std::unique_ptr<Program>& program =
      grounds_[{ground, kind.objects, kind.shadow, kind.ground, kind.sky}];
  if (program) return *program;
  std::string defines;
  if (ground == Ground::kRanged) defines += "#define RANGE\n";
  if (ground == Ground::kCached) defines += "#define CACHED\n";
  if (kind.objects) defines += "#define OBJECTS\n";
  if (kind.shadow) defines += "#define SHADOW\n";
  if (kind.ground) defines += "#define GROUND\n";
  if (kind.sky) defines += "#define SKY\n";
  if (other_lights_) defines += kOtherLights;
  program = std::make_unique<Program>(gl_, std::string(shaders::kVersion) + shaders::kSceneVertex,
                                      fragment(shaders::kSceneFragment, defines));
  return *program;
}

void GlPainter::compose(Ground ground, const Frame& frame, GLuint target, const Shine& shine,
                        const std::vector<TileRun>& runs) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
  limit(whole());
  gl_.Disable(GL_DEPTH_TEST);
  bind(kObjects, GL_TEXTURE_2D_MULTISAMPLE, textures_->object_color);
  if (ground == Ground::kRanged) bind(kFirst, GL_TEXTURE_2D_MULTISAMPLE, textures_->object_depth);
  if (ground == Ground::kCached) {
    bind(kFirst, GL_TEXTURE_2D, textures_->in_light);
    bind(kSecond, GL_TEXTURE_2D, textures_->in_shade);
    bind(kThird, GL_TEXTURE_2D, textures_->range);
  }
  for (int bits = 0; bits < 16; ++bits) {
    const TileRun kind{{}, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
    if (!upload_tiles(runs, kind)) continue;
    const Program& program = program_for(ground, kind);
    program.use();
    set_lighting(program, frame, shine);
    set_backdrop(program, frame);
    program.set("objects", static_cast<int>(kObjects));
    program.set("object_depth", static_cast<int>(kFirst));
    program.set("in_light", static_cast<int>(kFirst));
    program.set("in_shade", static_cast<int>(kSecond));
    program.set("range", static_cast<int>(kThird));
    tiles_.draw();
  }
  gl_.Disable(GL_SCISSOR_TEST);
}

void GlPainter::set_backdrop(const Program& program, const Frame& frame) const {
  const View& view = frame.view;
  const Backdrop& backdrop = frame.backdrop;
  // a ray's length is its depth
  program.set("ray_centre", Vec3(-view.R_WC.col(2)));
  program.set("ray_right", Vec3(view.tan_half_x * view.R_WC.col(0)));
  program.set("ray_up", Vec3(view.tan_half_y * view.R_WC.col(1)));
  program.set("ground_color", backdrop.ground_color);
  program.set("horizon_color", backdrop.horizon_color);
  program.set("zenith_color", backdrop.zenith_color);
  program.set("middle", backdrop.middle);
  program.set("ground_z", backdrop.ground_z);
  program.set("grid", backdrop.grid ? 1.0 : 0.0);
  program.set("cell", backdrop.cell);
  program.set("fade_from", backdrop.fade_from);
  program.set("fade_to", backdrop.fade_to);
  program.set("line_width", view.fineness);
  program.set("line_shade", backdrop.line_shade);
  program.set("depth_terms", Vec2(view.far * view.near / (view.far - view.near),
                                  view.far / (view.far - view.near)));
}

void GlPainter::set_lighting(const Program& program, const Frame& frame, const Shine& shine) const {
  const Lighting& light = frame.light;
  program.set("eye", frame.view.eye);
  program.set("to_key", light.to_key);
  program.set("key_color", shine.key ? light.key_color : Vec3(Vec3::Zero()));
  program.set("ambient_up", light.ambient_up);
  program.set("ambient_down", light.ambient_down);
  std::vector<Vec4> places, axes;
  std::vector<Vec3> colors;
  for (const Lighting::Other& other : light.others) {
    places.push_back(other.place);
    axes.push_back(other.axis);
    colors.push_back(other.color);
  }
  program.set("light_count", static_cast<int>(light.others.size()));
  program.set("light_place", places);
  program.set("light_axis", axes);
  program.set("light_color", colors);
  program.set("light_clip", light_clip(frame));
  const double texel = 1.0 / shadow_size_;
  program.set("shadow_texel", texel);
  program.set("shadow_softness", kShadowSoftness);
  program.set("shadow_search", std::round(std::log2(kShadowSoftness * shadow_size_)));
  program.set("shadow_normal_offset", kShadowOffsetTexels * texel * 2 * frame.shadow_ball.radius);
  program.set("shadowed", shine.shadows ? 1.0 : 0.0);
  program.set("shadow_map", static_cast<int>(kShadowMap));
  program.set("shadow_cover", static_cast<int>(kShadowCover));
  const bool still = shine.casters == Which::kStill;
  const GlTextures::Shadow& shadow = still ? textures_->still : textures_->moving;
  bind(kShadowMap, GL_TEXTURE_2D, shadow.depth, textures_->compare);
  bind(kShadowCover, GL_TEXTURE_2D, shadow.cover, textures_->levels);
}

void GlPainter::bind(GLuint unit, GLenum kind, GLuint texture, GLuint sampler) const {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(kind, texture);
  gl_.BindSampler(unit, sampler);
}

void GlPainter::limit(const Region& r) const {
  gl_.Viewport(0, 0, width_, height_);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Scissor(r.x0, r.y0, r.width(), r.height());
}

void GlPainter::read(const Region& r, std::vector<std::uint8_t>& pixels) const {
  pixels.resize(4 * static_cast<std::size_t>(r.width()) * static_cast<std::size_t>(r.height()));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->to_picture);
  gl_.ReadPixels(r.x0, r.y0, r.width(), r.height(), GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
}

void GlPainter::read_still(std::vector<std::uint8_t>& pixels, std::vector<float>& range) const {
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  pixels.resize(4 * count);
  range.resize(count);
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->to_in_light);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, textures_->to_range);
  gl_.ReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, range.data());
}

}  // namespace cprsim
