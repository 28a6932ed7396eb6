#include "core/se3.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <random>

namespace tessera {
namespace {

// exp of the 4 x 4 twist matrix: the 20-term power series of one eighth of it, then squared three
// times.
Eigen::Matrix4d SeriesExp(const Vector6d& twist) {
    Eigen::Matrix4d X = Eigen::Matrix4d::Zero();
    X.topLeftCorner<3, 3>() = Skew(twist.head<3>());
    X.topRightCorner<3, 1>() = twist.tail<3>();
    X /= 8.0;
    Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
    for (int n = 1; n <= 20; ++n) {
        term = term * X / n;
        sum += term;
    }
    for (int i = 0; i < 3; ++i) sum = sum * sum;
    return sum;
}

Vector6d RandomTwist(std::mt19937& random, double angle_rad) {
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 * 2.0 - 1.0; };
    Eigen::Vector3d axis(uniform(), uniform(), uniform());
    Vector6d twist;
    twist << axis.normalized() * angle_rad, uniform(), uniform(), uniform();
    return twist;
}

TEST(Se3, SkewIsTheCrossProduct) {
    const Eigen::Vector3d a(1, 2, 3), b(-4, 5, 0.5);
    EXPECT_EQ(Skew(a) * b, a.cross(b));
}

TEST(Se3, ExpAgreesWithTheSeries) {
    std::mt19937 random(1);
    for (const double angle : {0.0, 1e-14, 1e-9, 9.9e-5, 1.01e-4, 0.1, 1.0, 3.0, 3.14159, 5.0})
        for (int i = 0; i < 20; ++i) {
            const Vector6d twist = RandomTwist(random, angle);
            const double error = (Se3Exp(twist).matrix() - SeriesExp(twist)).cwiseAbs().maxCoeff();
            EXPECT_LT(error, 2e-12) << "angle " << angle;
        }
}

TEST(Se3, RotationComesFirst) {
    Vector6d twist = Vector6d::Zero();
    twist(2) = std::numbers::pi / 2;  // about z
    const Eigen::Vector3d turned = Se3Exp(twist) * Eigen::Vector3d(1, 0, 0);
    EXPECT_LT((turned - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
    twist.setZero();
    twist(5) = 2.0;  // along z
    EXPECT_EQ(Se3Exp(twist).translation(), Eigen::Vector3d(0, 0, 2));
    EXPECT_EQ(Se3Exp(twist).linear(), Eigen::Matrix3d::Identity());
}

TEST(Se3, LogInvertsExp) {
    std::mt19937 random(2);
    for (const double angle : {0.0, 1e-13, 1e-8, 1e-4, 0.3, 1.5, 3.0, std::numbers::pi - 1e-6})
        for (int i = 0; i < 20; ++i) {
            const Vector6d twist = RandomTwist(random, angle);
            EXPECT_LT((Se3Log(Se3Exp(twist)) - twist).norm(), 1e-9) << "angle " << angle;
        }
}

// At exactly pi the axis may come back reversed, but the motion must be the same.
TEST(Se3, ExpInvertsLogAtPi) {
    std::mt19937 random(3);
    for (const double off : {0.0, 1e-15, -1e-9, 1e-9, 1e-4})
        for (int i = 0; i < 20; ++i) {
            const Eigen::Isometry3d T = Se3Exp(RandomTwist(random, std::numbers::pi + off));
            const Vector6d twist = Se3Log(T);
            EXPECT_LE(twist.head<3>().norm(), std::numbers::pi + 1e-12);
            EXPECT_LT((Se3Exp(twist).matrix() - T.matrix()).norm(), 1e-9) << "pi + " << off;
        }
}

TEST(Se3, LogOfTheNegativeQuaternionIsTheSame) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() =
        Eigen::AngleAxisd(2 * std::numbers::pi - 0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
    EXPECT_NEAR(Se3Log(T)(0), -0.5, 1e-12);
}

// T_new = exp(increment) * T_old moves the camera along the world axes, whatever its orientation.
TEST(Se3, IncrementsMultiplyFromTheLeft) {
    Vector6d old_twist;
    old_twist << 0.4, -1.1, 0.2, 1, 2, 3;
    const Eigen::Isometry3d T_old = Se3Exp(old_twist);
    Vector6d increment = Vector6d::Zero();
    increment(3) = 0.25;
    const Eigen::Isometry3d T_new = Se3Exp(increment) * T_old;
    EXPECT_LT((T_new.translation() - T_old.translation() - Eigen::Vector3d(0.25, 0, 0)).norm(),
              1e-15);
    EXPECT_LT((T_new.linear() - T_old.linear()).norm(), 1e-15);

    // d (exp(increment) * p) / d increment at 0 is [-Skew(p), I].
    const Eigen::Vector3d p(0.3, -0.7, 2.0);
    for (int i = 0; i < 6; ++i) {
        const double h = 1e-6;
        const Eigen::Vector3d numeric =
            (Se3Exp(Vector6d::Unit(i) * h) * p - Se3Exp(Vector6d::Unit(i) * -h) * p) / (2 * h);
        const Eigen::Vector3d analytic = i < 3 ? Eigen::Vector3d(-Skew(p).col(i))
                                               : Eigen::Vector3d(Eigen::Vector3d::Unit(i - 3));
        EXPECT_LT((numeric - analytic).norm(), 1e-9) << "component " << i;
    }
}

TEST(Se3, TheAdjointMovesAMotionToTheOtherSide) {
    const Vector6d twist = (Vector6d() << 0.2, -0.1, 0.4, 0.3, 0.5, -0.2).finished();
    const Eigen::Isometry3d T = Se3Exp((Vector6d() << -0.5, 1.1, 0.3, 2, -1, 0.7).finished());
    EXPECT_TRUE((Se3Exp(Adjoint(T) * twist) * T).isApprox(T * Se3Exp(twist), 1e-12));
}

TEST(Se3, NormalisedIsRigidAndKeepsWhatIs) {
    Vector6d twist;
    twist << 0.3, -0.2, 0.5, 1, 2, 3;
    const Eigen::Isometry3d T = Se3Exp(twist);
    Eigen::Isometry3d worn = T;
    worn.linear() *= 1.0001;
    const Eigen::Isometry3d rigid = Normalised(worn);
    EXPECT_LT((rigid.linear() * rigid.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-14);
    EXPECT_TRUE(rigid.isApprox(T, 1e-4));
    EXPECT_TRUE(Normalised(T).isApprox(T, 1e-14));
}

TEST(Se3, RotationAngle) {
    Vector6d a = Vector6d::Zero(), b = Vector6d::Zero();
    a(1) = 0.2;
    b(1) = -0.3;
    b(4) = 9;
    EXPECT_NEAR(RotationAngle(Se3Exp(a), Se3Exp(b)), 0.5, 1e-12);
    EXPECT_NEAR(RotationAngle(Se3Exp(a), Se3Exp(a)), 0, 1e-7);
}

}  // namespace
}  // namespace tessera
