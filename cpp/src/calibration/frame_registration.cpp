#include "saras/calibration/frame_registration.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "saras/calibration/calibration_error.hpp"
#include "saras/spatial/validate.hpp"

namespace saras {
namespace {

using Points = std::vector<Vector3>;

/// Pseudo-observations behind touch_noise_m: three touches leave only three degrees of freedom to estimate it from.
constexpr double kPriorFreedom = 6.0;
/// Points of the board nearer than this are the same dot.
constexpr double kSameDot_m = 1e-6;
constexpr std::size_t kMostPermutedDots = 7;

[[noreturn]] void refuse(const std::string& text) { throw CalibrationError(text); }

std::string number(double value, int digits = 3) {
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

std::string millimetres(double value_m) { return number(1e3 * value_m) + " mm"; }

Vector3 mean(const Points& points) {
  Vector3 sum = Vector3::Zero();
  for (const auto& point : points) {
    sum += point;
  }
  return sum / static_cast<double>(points.size());
}

/// RMS extents along the principal axes, largest first.
Vector3 extents(const Points& points) {
  const Vector3 center = mean(points);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& point : points) {
    scatter += (point - center) * (point - center).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter / static_cast<double>(points.size()));
  return axes.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

Pose kabsch(const Points& touched, const Points& board) {
  const Vector3 a = mean(touched);
  const Vector3 b = mean(board);
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < touched.size(); ++i) {
    correlation += (touched[i] - a) * (board[i] - b).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  Pose pose;
  pose.rotation = Quaternion(svd.matrixU() * sign * svd.matrixV().transpose()).normalized();
  pose.translation = a - pose.rotation * b;
  return pose;
}

double rms(const Pose& base_T_board, const Points& touched, const Points& board) {
  double sum = 0.0;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    sum += (touched[i] - base_T_board * board[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(touched.size()));
}

/// Index of each point among the different dots, in the order of their first appearance.
std::vector<std::size_t> labels(const Points& board, Points& dots) {
  std::vector<std::size_t> label;
  for (const auto& point : board) {
    std::size_t i = 0;
    while (i < dots.size() && (dots[i] - point).norm() > kSameDot_m) {
      ++i;
    }
    if (i == dots.size()) {
      dots.push_back(point);
    }
    label.push_back(i);
  }
  return label;
}

/// The order of the dots that explains the touches, as text; empty when none does.
std::string other_order(const Points& touched, const std::vector<std::size_t>& label, const Points& dots,
                        double max_rms_m) {
  if (dots.size() > kMostPermutedDots) {
    return {};
  }
  std::vector<std::size_t> order(dots.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  double best = max_rms_m;
  std::vector<std::size_t> found;
  Points board(touched.size());
  do {
    for (std::size_t i = 0; i < touched.size(); ++i) {
      board[i] = dots[order[label[i]]];
    }
    const double fit = rms(kabsch(touched, board), touched, board);
    if (fit < best) {
      best = fit;
      found = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  std::string text;
  for (const std::size_t i : found) {
    text += (text.empty() ? "" : ", ") + std::to_string(i + 1);
  }
  return text.empty() ? text : text + " (" + millimetres(best) + " rms)";
}

void check_input(const Points& touched, const Points& board, const FrameFromPointsOptions& options) {
  if (touched.size() != board.size()) {
    refuse("touched: " + std::to_string(touched.size()) + " points for " + std::to_string(board.size()) +
           " board_points: must be as many");
  }
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (!touched[i].allFinite() || !board[i].allFinite()) {
      refuse("point " + std::to_string(i + 1) + ": must be finite");
    }
  }
  Points dots;
  labels(board, dots);
  if (dots.size() < 3) {
    refuse("different dots = " + std::to_string(dots.size()) + ": must be >= 3");
  }
  const double board_spread_m = extents(board)[1];
  if (board_spread_m < options.min_spread_m) {
    refuse("board_points: extent across their best line = " + millimetres(board_spread_m) +
           ": must be >= " + millimetres(options.min_spread_m) + " (collinear, or all at one place)");
  }
  const Vector3 size = extents(touched);
  const double ratio = size.norm() / extents(board).norm();
  if (ratio > 100.0 || (ratio < 0.01 && size[1] > 0.01)) {
    refuse("touched: " + number(ratio) + " times as large as the board: are the units millimetres?");
  }
  if (size[1] < 0.5 * options.min_spread_m) {
    refuse("touched: extent across their best line = " + millimetres(size[1]) +
           ": must be >= " + millimetres(0.5 * options.min_spread_m) + " (collinear, or the same dot again and again)");
  }
}

/// Says why the fit is bad: another order, one bad touch, or another board.
[[noreturn]] void refuse_fit(const Points& touched, const Points& board, const Pose& fit, double rms_m,
                             const FrameFromPointsOptions& options) {
  const std::string what =
      "residual = " + millimetres(rms_m) + " rms: must be <= " + millimetres(options.max_rms_m) + ": ";
  Points dots;
  const auto label = labels(board, dots);
  const std::string order = other_order(touched, label, dots, options.max_rms_m);
  if (!order.empty()) {
    refuse(what + "dots touched in the wrong order; they fit as dots " + order);
  }
  for (std::size_t left_out = 0; touched.size() > 4 && left_out < touched.size(); ++left_out) {
    Points t = touched;
    Points b = board;
    t.erase(t.begin() + static_cast<std::ptrdiff_t>(left_out));
    b.erase(b.begin() + static_cast<std::ptrdiff_t>(left_out));
    const Pose pose = kabsch(t, b);
    if (extents(b)[1] >= options.min_spread_m && rms(pose, t, b) <= options.max_rms_m) {
      refuse(what + "touch " + std::to_string(left_out + 1) + " is off by " +
             millimetres((touched[left_out] - pose * board[left_out]).norm()) + ", the others fit: take it again");
    }
  }
  std::size_t worst = 0;
  for (std::size_t i = 1; i < touched.size(); ++i) {
    if ((touched[i] - fit * board[i]).norm() > (touched[worst] - fit * board[worst]).norm()) {
      worst = i;
    }
  }
  const double ratio = extents(touched).norm() / extents(board).norm();
  refuse(what + "no order of the dots fits; worst is touch " + std::to_string(worst + 1) + ", and the touches are " +
         number(ratio) + " times as large as the board: wrong board, wrong print scale, or wrong tool length?");
}

Matrix6 covariance_of(const Pose& base_T_board, const Points& board, double squared_residuals,
                      const FrameFromPointsOptions& options) {
  Matrix6 information = Matrix6::Zero();
  for (const auto& point : board) {
    const Vector3 lever = base_T_board.rotation * point;
    Eigen::Matrix<double, 3, 6> jacobian;  // d(point) = dt + dtheta x lever
    jacobian.leftCols<3>().setIdentity();
    jacobian.rightCols<3>() << 0.0, lever.z(), -lever.y(), -lever.z(), 0.0, lever.x(), lever.y(), -lever.x(), 0.0;
    information += jacobian.transpose() * jacobian;
  }
  const double freedom = 3.0 * static_cast<double>(board.size()) - 6.0;
  const double prior = kPriorFreedom * options.touch_noise_m * options.touch_noise_m;
  // - 2: the level of noise is an estimate itself, so this is the covariance of Student's distribution.
  const double variance = (squared_residuals + prior) / (freedom + kPriorFreedom - 2.0);
  return variance * information.inverse();
}

}  // namespace

void FrameFromPointsOptions::validate() const {
  validate::positive("touch_noise_m", touch_noise_m);
  validate::positive("max_rms_m", max_rms_m);
  validate::positive("min_spread_m", min_spread_m);
  if (above) {
    validate::finite("above", *above);
  }
}

FrameFromPoints frame_from_points(const Points& touched, const Points& board_points,
                                  const FrameFromPointsOptions& options) {
  options.validate();
  check_input(touched, board_points, options);
  FrameFromPoints result;
  result.base_T_board = kabsch(touched, board_points);
  result.spread_m = extents(board_points)[1];
  result.rms_m = rms(result.base_T_board, touched, board_points);
  if (result.rms_m > options.max_rms_m) {
    refuse_fit(touched, board_points, result.base_T_board, result.rms_m, options);
  }
  double squared = 0.0;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    result.residuals.emplace_back(touched[i] - result.base_T_board * board_points[i]);
    squared += result.residuals.back().squaredNorm();
  }
  if (options.above) {
    const double height_m = (result.base_T_board.inverse() * *options.above).z();
    if (height_m <= 0.0) {
      refuse("board seen from behind: the trocar is " + millimetres(-height_m) +
             " below the printed side: must be above it");
    }
  }
  result.covariance = covariance_of(result.base_T_board, board_points, squared, options);
  return result;
}

Pose frame_from_three_points(const Vector3& first, const Vector3& second, const Vector3& third) {
  const Vector3 a = second - first;
  const Vector3 b = third - first;
  const Vector3 normal = a.cross(b);
  if (!normal.allFinite() || normal.norm() <= 1e-6 * a.norm() * b.norm() || normal.norm() == 0.0) {
    refuse("three points: must be finite and not collinear");
  }
  const Vector3 to_center =
      (a.squaredNorm() * b.cross(normal) + b.squaredNorm() * normal.cross(a)) / (2.0 * normal.squaredNorm());
  Eigen::Matrix3d axes;
  axes.col(0) = -to_center.normalized();
  axes.col(2) = normal.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {Quaternion(axes).normalized(), first + to_center};
}

}  // namespace saras
