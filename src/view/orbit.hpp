#pragma once

#include <burnish/mesh.hpp>
#include <burnish/scene.hpp>
#include <glm/glm.hpp>
#include <optional>

/// How hands move a camera. Angles in degrees; nothing here changes a camera that it is not given.
namespace burnish::view {

/// A ball around everything that can be looked at.
struct Ball {
    glm::vec3 centre{0.0F};
    float radius = 1.0F;  ///< > 0
};
/// Around the meshes of `scene`, in world space; a unit ball where there is none.
Ball ball_around(const Scene& scene);

/// A camera by vectors that sees what `camera` sees: one with a view matrix gets its vectors from
/// it, its focal point as far away as the ball's centre. A projection matrix is dropped, its angle
/// kept.
Camera by_vectors(const Camera& camera, const Ball& ball);

/// About the focal point: `azimuth` around view_up, positive to the left, then `elevation` towards
/// it, short of the poles by a degree.
Camera orbited(Camera camera, float azimuth, float elevation);
/// Moves camera and focal point, so that what is at the focal point follows a hand that goes by
/// (right, down) of a picture's height.
Camera panned(Camera camera, float right, float down);
/// Nearer by `factor` > 1, away by one below; never closer than a thousandth of the ball.
Camera zoomed(Camera camera, float factor, const Ball& ball);

/// No coordinate is infinite or not a number.
bool is_finite(const glm::vec3& v);
/// Finite, and position and focal point are two.
bool has_direction(const Camera& camera);

enum class Side { front, right, top, isometric };
/// From that side, all of the ball in the picture, y up. `aspect` is width / height.
Camera seen_from(Side side, const Camera& camera, const Ball& ball, float aspect);

/// Near and far so that the ball is not cut, wherever the camera stands; wider than they are, not
/// narrower.
Camera with_depths(Camera camera, const Ball& ball);

/// The direction `towards` turned as the camera sees it: to the right and down.
glm::vec3 turned_light(const glm::vec3& towards, const Camera& camera, float right, float down);

}  // namespace burnish::view
