// The cage of a soft gripper finger, for Gmsh 4. Unit: millimetre.
//
// The finger stands on its base and points along +z; +y is the gripping side, -y the back with
// the bellows. The cage is a stack of rings. A ring has nine points: four corners and four
// middles of its sides, counted counter-clockwise from the corner (-x, -y), and its centre.
// Between two rings, eight wedges stand round the middle line; Gmsh cuts each into three
// tetrahedra. All curves have one segment, so that every point here is one control point, and
// node 9 i + j + 1 of the mesh is point j of ring i.
//
// The diagonals of the wedges' sides are given: upwards from the centre to middles and corners, and
// from middles to corners. So the cage is its own mirror image in x = 0 and in y = 0, there are no
// slivers, and every interior edge is shared by at least four tetrahedra.

SetFactory("Built-in");

height[] = {-1.25, 16.5, 33.5, 49.5, 64.5, 78.5, 90.75, 101.5};
half_width[] = {15, 14, 12.75, 12, 11.25, 10.5, 9.75, 9.25};
half_depth[] = {13, 12, 11, 10.25, 9.75, 9.25, 8.75, 8.25};
last = #height[] - 1;

// Points. Ring i: corners and middles 9 i + 1 .. 9 i + 8, centre 9 i + 9.
For i In {0:last}
  z = height[i];
  w = half_width[i];
  d = half_depth[i];
  p = 9*i;
  Point(p + 1) = {-w, -d, z};
  Point(p + 2) = { 0, -d, z};
  Point(p + 3) = { w, -d, z};
  Point(p + 4) = { w,  0, z};
  Point(p + 5) = { w,  d, z};
  Point(p + 6) = { 0,  d, z};
  Point(p + 7) = {-w,  d, z};
  Point(p + 8) = {-w,  0, z};
  Point(p + 9) = { 0,  0, z};
EndFor

// Curves. Ring i: rim 100 i + 1 .. 8, spokes from the centre 100 i + 21 .. 28; up to the next
// ring 100 i + 11 .. 18 and from centre to centre 100 i + 19.
For i In {0:last}
  For j In {1:8}
    k = j % 8 + 1;
    Line(100*i + j) = {9*i + j, 9*i + k};
    Line(100*i + 20 + j) = {9*i + 9, 9*i + j};
    If (i < last)
      Line(100*i + 10 + j) = {9*i + j, 9*i + 9 + j};
    EndIf
  EndFor
  If (i < last)
    Line(100*i + 19) = {9*i + 9, 9*i + 18};
  EndIf
EndFor
Transfinite Curve "*" = 2;

// Surfaces. Triangles of ring i: 100 i + 51 .. 58; up to the next ring the outer quadrilaterals
// 100 i + 1 .. 8 and the inner ones 100 i + 21 .. 28.
For i In {0:last}
  For j In {1:8}
    k = j % 8 + 1;
    s = 100*i + 50 + j;
    Curve Loop(s) = {100*i + 20 + j, 100*i + j, -(100*i + 20 + k)};
    Plane Surface(s) = {s};
  EndFor
EndFor
For i In {0:last-1}
  u = i + 1;
  For j In {1:8}
    k = j % 8 + 1;
    s = 100*i + j;
    Curve Loop(s) = {100*i + j, 100*i + 10 + k, -(100*u + j), -(100*i + 10 + j)};
    Plane Surface(s) = {s};
    If (j % 2 == 1)
      Transfinite Surface {s} = {9*i + j, 9*i + k, 9*u + k, 9*u + j} Left;
    Else
      Transfinite Surface {s} = {9*i + j, 9*i + k, 9*u + k, 9*u + j} Right;
    EndIf
    s = 100*i + 20 + j;
    Curve Loop(s) = {100*i + 20 + j, 100*i + 10 + j, -(100*u + 20 + j), -(100*i + 19)};
    Plane Surface(s) = {s};
    Transfinite Surface {s} = {9*i + 9, 9*i + j, 9*u + j, 9*u + 9} Right;
  EndFor
EndFor

// Volumes: the eight wedges above ring i are 10 i + 1 .. 8.
For i In {0:last-1}
  For j In {1:8}
    k = j % 8 + 1;
    v = 10*i + j;
    Surface Loop(v) = {100*i + 50 + j, 100*(i + 1) + 50 + j, 100*i + j,
                       100*i + 20 + j, 100*i + 20 + k};
    Volume(v) = {v};
  EndFor
EndFor

// What octruss reads: groups named `crease` hold sharp edges, groups named `corner` fixed points.
Physical Volume("finger") = Volume {:};
Physical Curve("crease base") = {1:8};
Physical Curve("crease tip") = {100*last + 1 : 100*last + 8};
Physical Point("corner base") = {1, 3, 5, 7};

// No point beyond those above: sizes far larger than the finger, taken from nowhere else.
Mesh.MeshSizeMin = 1000;
Mesh.MeshSizeMax = 1000;
Mesh.MeshSizeExtendFromBoundary = 0;
