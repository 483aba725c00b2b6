// Repairs for defective triangle surfaces from other programs. Each function repairs one kind of defect, keeps the
// order of the remaining vertices and triangles, renumbers regions and edges, and returns how much it changed. Readers
// call none of them; the caller chooses. Threads may call them with different meshes.
#ifndef PHRENIC_SERVER_MESH_REPAIR_H_
#define PHRENIC_SERVER_MESH_REPAIR_H_

#include "server/mesh/mesh.h"

namespace phrenic {

// Merges vertices within `tolerance` [m] of each other into the one with the lowest index, then removes unused
// vertices. Returns by how many vertices the mesh shrank.
int Weld(double tolerance, Mesh& mesh);

// Removes slivers, triangles whose smallest altitude is under `height` [m], without leaving holes and moving the
// surface by less than `height`: a needle's short edge is collapsed, a cap's long edge is flipped. If the flip is
// impossible the sliver is deleted at a boundary edge and kept elsewhere (non-manifold edge, or the new edge exists).
// Also removes duplicate triangles on the same three vertices: one of two with equal winding, both of two with opposite
// winding. Returns the number of slivers and duplicates.
int DropSlivers(double height, Mesh& mesh);

// Removes fins: pieces of surface that are attached at a non-manifold edge (three triangles or more) and have a
// boundary edge. Returns the number of triangles removed.
int DropFins(Mesh& mesh);

// Joins cuts: merges the ends of boundary edges that lie opposite each other, each end within `gap` [m] of its
// counterpart and within a quarter of both edges' lengths. Ends that an edge joins already stay apart. Returns the
// number of vertices merged into others.
int JoinCuts(double gap, Mesh& mesh);

// Gives each fan of triangles at a pinched vertex, and each of several bodies that touch along an edge of four
// triangles, a vertex of its own. The largest fan keeps its place; the others move by `apart` [m], or a multiple of it,
// towards their middle, so that no two vertices coincide. Surfaces that meet in three sheets stay. Returns the number
// of vertices added. Does nothing to a mesh with tetrahedra or edges of its own.
int SplitPinches(double apart, Mesh& mesh);

// Removes crumbs: components whose bounding box has a diagonal under `extent` [m] and under a twentieth of that of the
// largest component. Returns the number of components removed.
int DropCrumbs(double extent, Mesh& mesh);

// Makes the winding consistent: neighbours agree across manifold edges, and closed components face outwards (positive
// signed volume). An open or non-orientable component keeps the winding of its majority. A closed component inside the
// bounding box of another closed one may be a cavity; it keeps the winding of its majority. Returns the number of
// triangles flipped.
int Orient(Mesh& mesh);

}  // namespace phrenic

#endif  // PHRENIC_SERVER_MESH_REPAIR_H_
