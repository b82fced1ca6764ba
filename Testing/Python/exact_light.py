# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""An oracle for rooms with convex blocks: how much of a light arrives at a point, by two integrations that share no
code with the product nor with each other.

visible_form_factor() is exact but for rounding: it cuts from the light what each block hides, and sums Lambert's edge
formula over the polygons that are left. quadrature() counts: it tests one ray for each of many points on the light.
Points are tuples of three numbers, polygons lists of points.
"""
import math

import numpy


def sub(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def centroid(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


class HalfSpace:
    """The points p with normal . p >= offset."""

    def __init__(self, normal, point):
        self.normal = normal
        self.offset = dot(normal, point)

    def height(self, point):
        return dot(self.normal, point) - self.offset


def facing(normal, point, inside):
    """The half-space with `point` on its boundary that holds the point `inside`."""
    half = HalfSpace(normal, point)
    return half if half.height(inside) >= 0 else HalfSpace(tuple(-c for c in normal), point)


def face_planes(faces):
    """The inner half-space of each face of a convex block."""
    center = centroid([p for face in faces for p in face])
    return [facing(cross(sub(f[1], f[0]), sub(f[2], f[0])), f[0], center) for f in faces]


def split(polygon, half):
    """A convex polygon's parts inside and outside a half-space: Sutherland and Hodgman 1974."""
    inside, outside = [], []
    heights = [half.height(p) for p in polygon]
    for i, p in enumerate(polygon):
        q, hp, hq = polygon[i - 1], heights[i], heights[i - 1]
        if (hp > 0 and hq < 0) or (hp < 0 and hq > 0):
            t = hp / (hp - hq)
            crossing = tuple(a + t * (b - a) for a, b in zip(p, q))
            inside.append(crossing)
            outside.append(crossing)
        if hp >= 0:
            inside.append(p)
        if hp <= 0:
            outside.append(p)
    return inside if max(heights) > 0 else [], outside if min(heights) < 0 else []


def remove(polygons, halves):
    """What is left of convex polygons without the intersection of some half-spaces."""
    left = []
    for polygon in polygons:
        for half in halves:
            polygon, outside = split(polygon, half)
            if outside:
                left.append(outside)
            if not polygon:
                break
    return left


def shadow_volume(point, face, inner):
    """The half-spaces behind a face, as the point sees it."""
    middle = centroid(face)
    sides = [
        facing(cross(sub(a, point), sub(b, point)), point, middle) for a, b in zip(face, face[1:] + face[:1])]
    return [HalfSpace(tuple(-c for c in inner.normal), face[0])] + sides


def form_factor(point, normal, polygon):
    """Lambert's edge formula, for a polygon above the plane of the receiver."""
    total = 0.0
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        a, b = sub(a, point), sub(b, point)
        edge = cross(a, b)
        length = math.sqrt(dot(edge, edge))
        if length > 0:
            total += math.atan2(length, dot(a, b)) / length * dot(edge, normal)
    return abs(total) / (2 * math.pi)


def visible_form_factor(point, normal, light, blocks):
    """The share of the sky that the visible part of a light takes, weighted by the cosine.

    blocks: lists of faces. The light leaves a convex block by a face whose outside the point cannot see: so what a
    block hides is what lies behind such faces."""
    polygons = [part for part in [split(light, HalfSpace(normal, point))[0]] if part]
    for faces in blocks:
        for face, inner in zip(faces, face_planes(faces)):
            if inner.height(point) > 0:
                polygons = remove(polygons, shadow_volume(point, face, inner))
    return sum(form_factor(point, normal, polygon) for polygon in polygons)


def quadrature(point, normal, light, blocks, steps):
    """The same for a parallelogram above the receiver's plane, by the midpoint rule with steps x steps rays."""
    corner, first, second = (numpy.array(light[i]) for i in (0, 1, 3))
    t = (numpy.arange(steps) + 0.5) / steps
    targets = corner + t[:, None, None] * (first - corner) + t[None, :, None] * (second - corner)
    rays = targets - numpy.array(point)
    area = numpy.cross(first - corner, second - corner) / steps**2
    squares = (rays**2).sum(-1)
    kernel = numpy.abs(rays @ numpy.array(normal)) * numpy.abs(rays @ area) / (math.pi * squares**2)
    visible = numpy.ones(kernel.shape, bool)
    for faces in blocks:
        visible &= ~hits(numpy.array(point), rays, faces)
    return (kernel * visible).sum()


def hits(point, rays, faces):
    """Which of the segments point + s ray, s in [0, 1], pass through a convex block."""
    enter, leave = numpy.zeros(rays.shape[:-1]), numpy.ones(rays.shape[:-1])
    for inner in face_planes(faces):
        height, slope = inner.height(point), rays @ numpy.array(inner.normal)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            s = -height / slope
        enter = numpy.where(slope > 0, numpy.maximum(enter, s), enter)
        leave = numpy.where(slope < 0, numpy.minimum(leave, s), leave)
        leave = numpy.where((slope == 0) & (height < 0), -1.0, leave)
    return enter < leave
