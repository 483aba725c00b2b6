// Dimensions common to all generated structures, so that they fit together: the curve of the spine and the
// cross-section of the rib cage at every height.
//
// Frame: LPS (+x left, +y posterior, +z superior). x = 0 is the midsagittal plane, z = 0 the lower end plate of L3
// (disc L3/L4), y = 0 the mid-coronal plane of the lower rib cage. Lengths are in millimetres here; Generate returns
// metres. Thread-safe.
//
// Sources: rounded adult dimensions (vertebral bodies 17 to 28 mm high, transverse chest 26 cm, lower chest 20 cm deep,
// sternum tilted by 25-27 degrees, thoracic kyphosis with its vertex at T6) of general anatomy; rib cage and diaphragm
// extents 243 x 179 x 207 mm as listed in the project's physiology notes.
#ifndef PHRENIC_SERVER_ANATOMY_DIMENSIONS_H_
#define PHRENIC_SERVER_ANATOMY_DIMENSIONS_H_

#include <Eigen/Core>

namespace phrenic::anatomy {

inline constexpr int kRibs = 12;
inline constexpr int kVertebrae = 15;  // T1 to T12, then L1 to L3

// Returns y of the anterior faces of the vertebral bodies at height z [mm]: y = 20 + 25 cos(pi (z - 290) / 290),
// kyphotic at T6 and lordotic at L3.
double SpineFront(double z);

// Returns dy/dz of SpineFront.
double SpineSlope(double z);

struct VertebralBody {
  double bottom, top;   // z of the end plates [mm]
  double width, depth;  // of the end plates [mm]
  double Middle() const { return (bottom + top) / 2; }
};

// Returns vertebra 1 (T1) to 15 (L3). They are stacked upwards from z = 0, with discs of 8 mm (lumbar) to 3 mm (upper
// thoracic) between.
VertebralBody BodyOfVertebra(int number);

// The horizontal cross-section of the cage surface that holds the ribs' centrelines, offset inwards by `inset` [mm]: a
// rounded rectangle with an impression of the vertebral column. Immutable, thread-safe.
class CageSection {
 public:
  CageSection(double z, double inset);

  // Map unit-disc coordinates q (+x left, +y posterior; |q| = 1 is the outline) to (x, y) [mm], and back.
  Eigen::Vector2d Point(const Eigen::Vector2d& q) const;
  Eigen::Vector2d DiscCoordinates(const Eigen::Vector2d& point) const;

 private:
  double half_width_, half_depth_, centre_, column_;
};

// The section that a field has used last: grids and gradients ask for many points of one height. A field has one per
// thread. Not thread-safe.
class LastCageSection {
 public:
  // Returns CageSection(z, inset), valid until the next call.
  const CageSection& At(double z, double inset) {
    if (z != z_ || inset != inset_) {
      section_ = CageSection(z, inset);
      z_ = z, inset_ = inset;
    }
    return section_;
  }

 private:
  double z_ = 0, inset_ = 0;
  CageSection section_{0, 0};
};

// Returns y of the middle of the sternum at height z [mm].
double SternumLine(double z);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIMENSIONS_H_
