#include "server/record/gltf.h"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <array>
#include <cstring>
#include <optional>
#include <sstream>

#include "absl/strings/str_format.h"
#include "server/mesh/normals.h"

namespace phrenic::record {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr int kMaxFrames = 1000;
constexpr double kSinCos45 = 0.70710678118654752;  // of half the root's rotation by 90 degrees

using Floats = Eigen::Matrix3Xf;

// Builds the model's single binary buffer with its views and accessors.
class Builder {
 public:
  template <typename Derived>
  int AddAccessor(const Eigen::MatrixBase<Derived>& columns, int component, int type, int target) {
    const typename Derived::PlainObject plain = columns;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes_.size();
    view.byteLength = sizeof(typename Derived::Scalar) * static_cast<std::size_t>(plain.size());
    view.target = target;
    bytes_.resize(bytes_.size() + view.byteLength);
    std::memcpy(bytes_.data() + view.byteOffset, plain.data(), view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component;
    accessor.count = static_cast<std::size_t>(type == TINYGLTF_TYPE_VEC3 ? plain.cols() : plain.size());
    accessor.type = type;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(accessor);
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  // glTF requires bounds on POSITION accessors.
  int AddPositions(const Floats& columns) {
    const int index =
        AddAccessor(columns, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    SetBounds(columns.rowwise().minCoeff(), columns.rowwise().maxCoeff(), index);
    return index;
  }

  int AddScalars(const Eigen::VectorXf& numbers, bool bounded) {
    const int index = AddAccessor(numbers, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 0);
    if (bounded) {
      const auto bound = [](float number) { return Eigen::VectorXf::Constant(1, number).eval(); };
      SetBounds(bound(numbers.minCoeff()), bound(numbers.maxCoeff()), index);
    }
    return index;
  }

  tinygltf::Model& model() { return model_; }

  std::string Finish() && {
    model_.asset.version = "2.0";
    model_.asset.generator = "Phrenic";
    model_.buffers.resize(1);
    model_.buffers[0].data = std::move(bytes_);
    std::ostringstream file;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, file, false, true);
    return std::move(file).str();
  }

 private:
  void SetBounds(const Eigen::VectorXf& least, const Eigen::VectorXf& greatest, int index) {
    tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
    accessor.minValues.assign(least.begin(), least.end());
    accessor.maxValues.assign(greatest.begin(), greatest.end());
  }

  tinygltf::Model model_;
  std::vector<unsigned char> bytes_;
};

class GltfRecorder final : public Recorder {
 public:
  explicit GltfRecorder(Settings settings) : sink_(std::move(settings.sink)) {}

  absl::Status Begin(const Recording& recording) override {
    bodies_ = recording.bodies;
    return absl::OkStatus();
  }

  absl::Status AddFrame(const RecordedFrame& frame) override {
    const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(frame.positions.size());
    if ((times_.size() + 1) * bytes > kMaxBytes || times_.size() >= kMaxFrames) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("a .glb holds at most %d MiB of key frames, and at most %d of them; frame %d exceeds that: "
                          "record fewer frames "
                          "per second, a shorter time or fewer bodies, or use .pvd",
                          kMaxBytes >> 20, kMaxFrames, times_.size() + 1));
    }
    times_.push_back(static_cast<float>(frame.time - first_time_.value_or(frame.time)));
    if (!first_time_) first_time_ = frame.time, first_ = frame.positions;
    changes_.emplace_back((frame.positions - first_).cast<float>());
    return absl::OkStatus();
  }

  absl::Status End(const std::function<absl::Status(double share)>& /*report*/) override {
    AddRoot();
    Eigen::Index first = 0;
    for (const RecordedBody& body : bodies_) {
      if (body.mesh.triangles.cols() + body.mesh.edges.cols() > 0) AddBody(body, first);
      first += body.mesh.vertices.cols();
    }
    if (times_.size() > 1) AddAnimation();
    return sink_(std::move(builder_).Finish());
  }

 private:
  // Rotates LPS to glTF's axes (+y up, +z towards the viewer, who faces the chest): -90 degrees about x.
  void AddRoot() {
    tinygltf::Node root;
    root.name = "LPS to y up";
    root.rotation = {-kSinCos45, 0, 0, kSinCos45};
    builder_.model().nodes.push_back(root);
    tinygltf::Scene scene;
    scene.nodes = {0};
    builder_.model().scenes.push_back(scene);
    builder_.model().defaultScene = 0;
  }

  void AddBody(const RecordedBody& body, Eigen::Index first) {
    tinygltf::Model& model = builder_.model();
    tinygltf::Mesh mesh;
    mesh.name = body.name;
    mesh.primitives.push_back(PrimitiveOf(body.mesh, first));
    mesh.weights.assign(mesh.primitives[0].targets.size(), 0.0);
    tinygltf::Node node;
    node.name = body.name;
    node.mesh = static_cast<int>(model.meshes.size());
    model.nodes[0].children.push_back(static_cast<int>(model.nodes.size()));
    model.meshes.push_back(mesh);
    model.nodes.push_back(node);
    tinygltf::Material material;
    material.name = body.name;
    material.doubleSided = true;
    const std::size_t index = model.materials.size() % kColours.size();
    material.pbrMetallicRoughness.baseColorFactor = {kColours[index].begin(), kColours[index].end()};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.6;
    model.materials.push_back(material);
  }

  // The first frame is the mesh; each other frame's displacement from it is a morph target.
  tinygltf::Primitive PrimitiveOf(const Mesh& mesh, Eigen::Index first) {
    const Eigen::Index count = mesh.vertices.cols();
    const bool surface = mesh.triangles.cols() > 0;
    const Points at_first = first_.middleCols(first, count);
    tinygltf::Primitive primitive;
    primitive.mode = surface ? TINYGLTF_MODE_TRIANGLES : TINYGLTF_MODE_LINE;
    primitive.material = static_cast<int>(builder_.model().materials.size());
    primitive.attributes["POSITION"] = builder_.AddPositions(at_first.cast<float>());
    if (surface) {
      Floats normals = VertexNormals(at_first, mesh.triangles).cast<float>();
      for (auto normal : normals.colwise()) {
        // A vertex without a triangle; glTF requires unit vectors.
        if (normal.isZero()) normal = Eigen::Vector3f::UnitZ();
      }
      primitive.attributes["NORMAL"] = builder_.AddAccessor(normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                                            TINYGLTF_TARGET_ARRAY_BUFFER);
    }
    const Eigen::VectorX<std::uint32_t> corners =
        surface ? Eigen::VectorX<std::uint32_t>(mesh.triangles.reshaped().cast<std::uint32_t>())
                : Eigen::VectorX<std::uint32_t>(mesh.edges.reshaped().cast<std::uint32_t>());
    primitive.indices = builder_.AddAccessor(corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                             TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    for (std::size_t f = 1; f < changes_.size(); ++f) {
      primitive.targets.push_back({{"POSITION", builder_.AddPositions(changes_[f].middleCols(first, count))}});
    }
    return primitive;
  }

  // Each key frame's own target has weight 1, all others 0; viewers interpolate linearly.
  void AddAnimation() {
    const auto frames = static_cast<Eigen::Index>(times_.size());
    Eigen::MatrixXf weights = Eigen::MatrixXf::Zero(frames - 1, frames);
    for (Eigen::Index f = 1; f < frames; ++f) weights(f - 1, f) = 1;
    tinygltf::AnimationSampler sampler;
    sampler.input = builder_.AddScalars(Eigen::Map<const Eigen::VectorXf>(times_.data(), frames), true);
    sampler.output = builder_.AddScalars(weights.reshaped(), false);
    sampler.interpolation = "LINEAR";
    tinygltf::Animation animation;
    animation.name = "motion";
    animation.samplers.push_back(sampler);
    for (std::size_t node = 1; node < builder_.model().nodes.size(); ++node) {
      tinygltf::AnimationChannel channel;
      channel.sampler = 0;
      channel.target_node = static_cast<int>(node);
      channel.target_path = "weights";
      animation.channels.push_back(channel);
    }
    builder_.model().animations.push_back(animation);
  }

  // Muscle, bone, lung, other; red, green, blue, opacity.
  static constexpr std::array<std::array<double, 4>, 4> kColours = {
      {{0.72, 0.26, 0.22, 1}, {0.89, 0.85, 0.75, 1}, {0.85, 0.58, 0.60, 1}, {0.45, 0.57, 0.72, 1}}};

  const Sink sink_;
  std::vector<RecordedBody> bodies_;
  std::optional<double> first_time_;
  Points first_;
  std::vector<float> times_;
  std::vector<Floats> changes_;  // displacement of each frame from the first [m]
  Builder builder_;
};

}  // namespace

std::unique_ptr<Recorder> MakeGltfRecorder(Settings settings) {
  return std::make_unique<GltfRecorder>(std::move(settings));
}

}  // namespace phrenic::record
