#pragma once
// Closed meshes of known inside and volume, and what may be wrong with them.
#include <cstdint>
#include <string>

#include "model/triangle_mesh.h"

namespace aspic::test {

/// A box from −half to half, 12 faces.
TriangleMesh box_mesh(const Vec3& half, const Vec3& center = {});
/// A sphere around a point: an icosahedron divided `levels` times, 20·4^levels faces.
TriangleMesh sphere_mesh(int levels, double radius, const Vec3& center = {});
/// A torus around the y axis, 2·around·across faces.
TriangleMesh torus_mesh(int around, int across, double radius, double tube);
/// The volume that such a mesh encloses: of its polygons, not of the round body.
double torus_volume(int around, int across, double radius, double tube);

/// Both as one.
TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b);
/// Without a share of the faces, chosen by a seed.
TriangleMesh without_share(const TriangleMesh& mesh, double share, std::uint64_t seed);
/// Without the faces whose center lies above a height.
TriangleMesh without_above(const TriangleMesh& mesh, double height);
/// With a share of the faces turned.
TriangleMesh with_turned(const TriangleMesh& mesh, double share, std::uint64_t seed);
/// Every face has corners of its own.
TriangleMesh as_soup(const TriangleMesh& mesh);

/// The mesh as a binary STL file.
std::string as_stl(const TriangleMesh& mesh);

}  // namespace aspic::test
