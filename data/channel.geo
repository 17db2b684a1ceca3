// The channel with a cylinder of the DFG benchmark "Flow around a cylinder" in two dimensions:
// channel [0, 2.2] x [0, 0.41], cylinder of radius 0.05 around (0.2, 0.2), lengths in metres.
// Source: M. Schaefer, S. Turek, "Benchmark computations of laminar flow around a cylinder", in:
// Flow Simulation with High-Performance Computers II, Notes on Numerical Fluid Mechanics 52,
// Vieweg, 1996, pp. 547-566, figure 1.
//
// Sizes in metres, set from the command line: -setnumber near 0.02 -setnumber far 0.06
DefineConstant[
  near = 0.03,  // target edge length at the cylinder
  far = 0.08,   // ... at the channel's ends
  degree = 3
];
Point(1) = {0, 0, 0, far};
Point(2) = {2.2, 0, 0, far};
Point(3) = {2.2, 0.41, 0, far};
Point(4) = {0, 0.41, 0, far};
Point(5) = {0.2, 0.2, 0, near};
Point(6) = {0.25, 0.2, 0, near};
Point(7) = {0.2, 0.25, 0, near};
Point(8) = {0.15, 0.2, 0, near};
Point(9) = {0.2, 0.15, 0, near};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 8};
Circle(7) = {8, 5, 9};
Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
Physical Curve("inlet", 1) = {4};
Physical Curve("outlet", 2) = {2};
Physical Curve("walls", 3) = {1, 3};
Physical Curve("cylinder", 4) = {5, 6, 7, 8};
Physical Surface("fluid", 5) = {1};
Mesh.ElementOrder = degree;
Mesh.HighOrderOptimize = 2;
Mesh.Algorithm = 6;  // frontal Delaunay: unstructured
Mesh.MshFileVersion = 4.1;
