// Where objects stand, and the camera that sees all of them.
#include <gtest/gtest.h>

#include <burnish/error.hpp>
#include <burnish/files.hpp>
#include <cmath>
#include <vector>

namespace burnish {
namespace {

TEST(Placement, IsARotationWithUniformScale) {
    const glm::mat4 m = placement({1, 2, 3}, {1, 1, 0}, 77.0F, 3.0F);
    EXPECT_EQ(m[3], glm::vec4(1, 2, 3, 1));
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(glm::dot(glm::vec3(m[i]), glm::vec3(m[j])), i == j ? 9.0F : 0.0F, 1e-5F);
    }
    EXPECT_GT(glm::determinant(m), 0.0F);
    // The axis stays where it is, 3 times as long.
    const glm::vec3 axis = glm::vec3(m * glm::vec4(1, 1, 0, 0));
    EXPECT_NEAR(axis.x, 3.0F, 1e-5F);
    EXPECT_NEAR(axis.y, 3.0F, 1e-5F);
}

TEST(Placement, QuarterTurnsAreExact) {
    const glm::mat4 m = placement({0, 0, 0}, {0, 0, 1}, 90.0F, 1.0F);
    EXPECT_NEAR(m[0][1], 1.0F, 0.0F);
    EXPECT_NEAR(m[0][0], 0.0F, 1e-16F);
    EXPECT_EQ(placement({0, 0, 0}, {0, 1, 0}, 0.0F, 1.0F), glm::mat4(1.0F));
    EXPECT_EQ(placement({0, 0, 0}, {0, 1, 0}, 725.0F, 1.0F),
              placement({0, 0, 0}, {0, 1, 0}, 5.0F, 1.0F));
}

TEST(Placement, RefusesWhatIsNoPlacement) {
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 0}, 1.0F, 1.0F), Error);
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 1}, 1.0F, 0.0F), Error);
    EXPECT_THROW(placement({0, 0, 0}, {0, 0, 1}, 1.0F, -1.0F), Error);
}

TEST(FramingCamera, SeesEveryCornerFromItsDirection) {
    for (const float aspect : {16.0F / 9.0F, 1.0F, 0.4F}) {
        const Bounds bounds{{-3, 1, 2}, {5, 4, 2.5F}};
        const Camera camera = framing_camera(bounds, aspect);
        const glm::vec3 arm = camera.position - camera.focal_point;
        EXPECT_NEAR(arm.x / arm.z, 0.5F, 1e-5F);
        EXPECT_NEAR(arm.y / arm.z, 0.35F, 1e-5F);
        const glm::vec3 forward = -arm / std::sqrt(glm::dot(arm, arm));
        const glm::vec3 side = glm::normalize(glm::cross(forward, camera.view_up));
        const glm::vec3 up = glm::cross(side, forward);
        const float slope = std::tan(camera.view_angle * 3.14159265F / 360.0F);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
                              (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                              (corner & 4) != 0 ? bounds.high.z : bounds.low.z};
            const glm::vec3 d = p - camera.position;
            const float depth = glm::dot(d, forward);
            EXPECT_GT(depth, camera.near);
            EXPECT_LT(depth, camera.far);
            EXPECT_LE(std::abs(glm::dot(d, up)), slope * depth);
            EXPECT_LE(std::abs(glm::dot(d, side)), slope * aspect * depth);
        }
    }
}

TEST(FramingCamera, APointStillGetsACamera) {
    const Camera camera = framing_camera({{1, 2, 3}, {1, 2, 3}}, 1.5F);
    EXPECT_EQ(camera.focal_point, glm::vec3(1, 2, 3));
    EXPECT_GT(camera.near, 0.0F);
    EXPECT_GT(camera.far, camera.near);
    EXPECT_NE(camera.position, camera.focal_point);
}

}  // namespace
}  // namespace burnish
