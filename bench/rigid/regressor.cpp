// Time of one regressor of a robot by Pinocchio: `regressor URDF SAMPLES` prints the least of 20 rounds, ns.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/parsers/urdf.hpp>

int main(int, char **arguments)
{
    pinocchio::Model model;
    pinocchio::urdf::buildModel(arguments[1], model);
    pinocchio::Data data(model);
    const int n = model.nv, samples = std::atoi(arguments[2]);
    Eigen::MatrixXd q(n, samples);
    for (int k = 0; k < samples * n; ++k)
        q.data()[k] = std::sin(k * 0.7) * 3.0;
    double least = std::numeric_limits<double>::infinity(), sum = 0.0;
    for (int round = 0; round < 20; ++round) {
        const auto start = std::chrono::steady_clock::now();
        for (int k = 0; k < samples; ++k)
            sum += pinocchio::computeJointTorqueRegressor(model, data, q.col(k), q.col(k), q.col(k))(0, 9);
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
        least = std::min(least, time.count() / samples);
    }
    std::printf("%.1f\n", least);
    return std::isfinite(sum) ? 0 : 1;
}
