// The laws that all generated parts share, so that they fit each other: the curve of the spine and the cross-section of
// the rib cage at every height.
//
// Frame: patient frame LPS (+x left, +y posterior, +z superior); x = 0 is the midsagittal plane, z = 0 the lower end
// plate of L3 (disc L3/L4), y = 0 the mid-coronal plane of the lower rib cage. The laws are written in millimetres, as
// anatomy gives them; Generate turns the finished surfaces into metres.
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

// y of the fronts of the vertebral bodies at height z: one cosine, convex backwards at T6, forwards at L3 [mm].
double SpineFront(double z);

// dy/dz of the spine's curve.
double SpineSlope(double z);

struct VertebralBody {
  double bottom, top;   // z of the end plates [mm]
  double width, depth;  // of the end plates [mm]
  double Middle() const { return (bottom + top) / 2; }
};

// Number 1 (T1) to 15 (L3), stacked upwards from z = 0 with discs of 8 mm (lumbar) to 3 mm (upper thoracic).
VertebralBody BodyOfVertebra(int number);

// The horizontal cross-section of the cage that carries the ribs' centrelines, moved inwards by `inset` [mm]: a rounded
// rectangle with the vertebral column pressed into its back.
class CageSection {
 public:
  CageSection(double z, double inset);

  // Unit-disc coordinates q (q.x to the left, q.y backwards; |q| = 1 is the outline) to (x, y) [mm], and back.
  Eigen::Vector2d Point(const Eigen::Vector2d& q) const;
  Eigen::Vector2d DiscCoordinates(const Eigen::Vector2d& point) const;

 private:
  double half_width_, half_depth_, centre_, column_;
};

// y of the middle of the sternum at height z [mm].
double SternumLine(double z);

}  // namespace phrenic::anatomy

#endif  // PHRENIC_SERVER_ANATOMY_DIMENSIONS_H_
