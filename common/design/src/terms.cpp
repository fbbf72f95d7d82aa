#include "terms.hpp"

#include <Eigen/LU>
#include <cmath>

namespace quorient::design {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;

constexpr double singular = 1e-12;  // limit of det A, with A of order one
constexpr double huge = 1e6;

Matrix3d information_without(const geometry::Axes& rows, AxisMask removed)
{
    Matrix3d a = Matrix3d::Zero();
    for (Index i = 0; i < rows.rows(); ++i)
        if (!has_axis(removed, static_cast<std::size_t>(i))) a += rows.row(i).transpose() * rows.row(i);
    return a;
}

template <class Row>
void put(Terms& terms, Index term, Index axis, const Row& change)
{
    const Index n = terms.gradient.cols() / 3;
    for (Index part = 0; part < 3; ++part) terms.gradient(term, part * n + axis) += change(part);
}

/// value(A^-1), and -2 M h of each row h that is left: d value = tr(dA^-1 …) with M = change(A^-1).
template <class Value, class Change>
Terms information_terms(const geometry::Axes& rows, std::span<const AxisMask> removed, Value value, Change change)
{
    Terms terms(static_cast<Index>(removed.size()), rows.rows());
    for (std::size_t k = 0; k < removed.size(); ++k) {
        const auto term = static_cast<Index>(k);
        const Matrix3d a = information_without(rows, removed[k]);
        if (a.determinant() < singular) {
            terms.value(term) = huge;
            continue;
        }
        const Matrix3d inverse = a.inverse();
        terms.value(term) = value(inverse);
        const Matrix3d factor = change(inverse);
        for (Index i = 0; i < rows.rows(); ++i)
            if (!has_axis(removed[k], static_cast<std::size_t>(i))) put(terms, term, i, factor * rows.row(i).transpose());
    }
    return terms;
}

/// The projector W, and H A^-1: dW = -(W dH A^-1 H' + its transpose).
struct Residuals {
    explicit Residuals(const geometry::Axes& rows)
    {
        const Matrix3d a = rows.transpose() * rows;
        good = a.determinant() > singular;
        if (!good) return;
        pseudo_inverse = rows * a.inverse();
        w = geometry::AxisMatrix::Identity(rows.rows(), rows.rows()) - pseudo_inverse * rows.transpose();
    }

    bool good;
    geometry::Axes pseudo_inverse;
    geometry::AxisMatrix w;
};

/// Adds d f for d f / d W_ij = slope (and as much for W_ji where i != j): the gradient by H is -2 W G (H A^-1), G symmetric.
void put_slope(Terms& terms, Index term, const Residuals& residuals, Index i, Index j, double slope)
{
    for (Index axis = 0; axis < residuals.w.rows(); ++axis) {
        put(terms, term, axis, -2 * slope * residuals.w(axis, i) * residuals.pseudo_inverse.row(j));
        if (i != j) put(terms, term, axis, -2 * slope * residuals.w(axis, j) * residuals.pseudo_inverse.row(i));
    }
}

}  // namespace

Terms trace_terms(const geometry::Axes& rows, std::span<const AxisMask> removed)
{
    return information_terms(
        rows, removed, [](const Matrix3d& inverse) { return inverse.trace(); },
        [](const Matrix3d& inverse) { return Matrix3d(-2 * inverse * inverse); });
}

Terms volume_terms(const geometry::Axes& rows, std::span<const AxisMask> removed)
{
    return information_terms(
        rows, removed, [](const Matrix3d& inverse) { return std::log(inverse.determinant()) / 2; },
        [](const Matrix3d& inverse) { return Matrix3d(-inverse); });
}

Terms cosine_terms(const geometry::Axes& axes, std::span<const AxisPair> pairs)
{
    Terms terms(static_cast<Index>(pairs.size()), axes.rows());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const auto [i, j] = pairs[k];
        const double cosine = axes.row(i).dot(axes.row(j));
        terms.value(static_cast<Index>(k)) = cosine * cosine;
        put(terms, static_cast<Index>(k), i, 2 * cosine * axes.row(j));
        put(terms, static_cast<Index>(k), j, 2 * cosine * axes.row(i));
    }
    return terms;
}

Terms visibility_terms(const geometry::Axes& rows)
{
    const Index n = rows.rows();
    Terms terms(n, n);
    const Residuals residuals(rows);
    for (Index i = 0; i < n; ++i) {
        terms.value(i) = residuals.good ? -residuals.w(i, i) : huge;
        if (residuals.good) put_slope(terms, i, residuals, i, i, -1);
    }
    return terms;
}

Terms rivalry_terms(const geometry::Axes& rows)
{
    const Index n = rows.rows();
    Terms terms(n * (n - 1), n);
    const Residuals residuals(rows);
    Index term = 0;
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            if (i == j) continue;
            const double own = residuals.good ? residuals.w(i, i) : 0;
            if (own * own < singular) {
                terms.value(term++) = huge;
                continue;
            }
            const double shared = residuals.w(i, j);
            terms.value(term) = shared * shared / (own * own);
            put_slope(terms, term, residuals, i, j, shared / (own * own));
            put_slope(terms, term, residuals, i, i, -2 * shared * shared / (own * own * own));
            ++term;
        }
    return terms;
}

Terms anisotropy_terms(const geometry::Axes& rows)
{
    struct Entry {
        Index i, j;
    };
    constexpr Entry off_diagonal[] = {{0, 1}, {0, 2}, {1, 2}};
    Terms terms(5, rows.rows());
    terms.value.setZero();
    const Index n = rows.rows();
    for (Index axis = 0; axis < n; ++axis) {
        Index term = 0;
        for (const auto [i, j] : off_diagonal) {
            terms.value(term) += rows(axis, i) * rows(axis, j);
            terms.gradient(term, i * n + axis) = rows(axis, j);
            terms.gradient(term, j * n + axis) = rows(axis, i);
            ++term;
        }
        for (const Index i : {Index{0}, Index{1}}) {
            terms.value(term) += rows(axis, i) * rows(axis, i) - rows(axis, 2) * rows(axis, 2);
            terms.gradient(term, i * n + axis) = 2 * rows(axis, i);
            terms.gradient(term, 2 * n + axis) = -2 * rows(axis, 2);
            ++term;
        }
    }
    return terms;
}

}  // namespace quorient::design
