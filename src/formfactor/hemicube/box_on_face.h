// The pixels of a hemicube's face on which a box may be seen, and how near it is.
#pragma once

#include <glm/mat3x3.hpp>

#include "base/geometry/box.h"
#include "formfactor/hemicube/eye_frame.h"
#include "formfactor/hemicube/face_buffer.h"
#include "formfactor/hemicube/face_geometry.h"

namespace radiosity {

/// Turns boxes into boxes along an eye's axes around them, in the eye's coordinates.
class BoxesFromEye {
 public:
  explicit BoxesFromEye(const EyeFrame& frame);
  Box3 operator()(const Box3& box) const;

 private:
  EyeFrame frame_;
  glm::dmat3 spread_;  ///< magnitudes of the axes
};

/// The pixels of `columns` x `rows` whose centres lie in a rectangle, in pixels.
PixelBox pixelsWithin(const Box2& rectangle, int columns, int rows);

struct BoxOnFace {
  PixelBox pixels;  ///< all whose centres the box may cover
  double nearest =
      0;  ///< inverse distance along the face's axis of its nearest corner, or infinity
};

/// `box`: in the eye's coordinates. `resolution`: pixels along an edge of the top face.
BoxOnFace boxOnFace(const Box3& box, const FaceGeometry& face, int resolution);

}  // namespace radiosity
