#include "cli/command_texts.h"

namespace radiosity::cli {

const char* descriptionOf(Command command) {
  switch (command) {
    case Command::info:
      return "Summarize a scene or results file and report problems";
    case Command::mesh:
      return "Cut the scene into patches";
    case Command::factors:
      return "Compute the form factors between the patches";
    case Command::solve:
      return "Solve B = E + rho F B for the radiosity of every patch";
    case Command::gather:
      return "Gather light through hemicubes, pass by pass, without a matrix";
    case Command::heat:
      return "Exchange heat by radiation: temperatures and net fluxes of surfaces";
    case Command::compare:
      return "Measure how far apart two lightings of one scene are, and where";
    case Command::render:
      return "Draw the lit scene, running missing stages first";
    case Command::illuminance:
      return "Measure illuminance, in lux, on grids and at points";
    case Command::view:
      break;
  }
  return "Write a page that shows the lit scene in a browser";
}

const char* examplesOf(Command command) {
  switch (command) {
    case Command::info:
      return "Examples:\n"
             "  radiosity info data/cornell-box.obj\n"
             "  radiosity info house.glb --set lamp.radiance=100\n"
             "  radiosity info cornell.h5\n"
             "  radiosity info --devices";
    case Command::mesh:
      return "Files (-o): .obj (outlines), .glb (triangles), .vtp (ParaView), .h5 (results).\n\n"
             "Examples:\n"
             "  radiosity mesh data/cornell-box.obj --patches 5000 -o patches.obj\n"
             "  radiosity mesh plan.obj --unit mm --max-edge 0.25 -o patches.glb";
    case Command::factors:
      return "Files (-o): .h5 (results), .mtx (MatrixMarket, F as stored), .vtp (patches with\n"
             "the accounts of their rows, for ParaView). Between surfaces: .csv, .json, .md\n"
             "(tables), .idf (EnergyPlus), .vf (View3D); of patches: .txt, .hdf5 (row, column,\n"
             "value). --between changes that, also of .mtx. A results file given as input is\n"
             "updated in place where no -o is given.\n\n"
             "Examples:\n"
             "  radiosity factors data/cornell-box.obj -o cornell.h5\n"
             "  radiosity factors cornell.h5 --between surfaces\n"
             "  radiosity factors cornell.h5 --between 50 -o nodes.mtx\n"
             "  radiosity factors cornell.h5 --group 'walls=*wall*' -o cornell.csv\n"
             "  radiosity factors plates.obj --faces-as-patches --tolerance 1e-11 -o plates.h5\n"
             "  radiosity factors data/cornell-box.obj --method hemicube --resolution 512\n"
             "  radiosity factors cornell.h5 -o cornell.mtx";
    case Command::solve:
      return "Files (-o): .h5 (results), .glb (lit mesh), .csv (B, H and net flux by patch), .vtp\n"
             "(the same for ParaView), .mtx (MatrixMarket). A results file given as input is\n"
             "updated in place where no -o is given; its form factors are reused.\n"
             "The lit mesh shows light at elements, finer than patches; a results file, which is\n"
             "for the matrix, keeps them beside a lit mesh or with --elements on.\n"
             "SCENE may be a matrix of any program, .mtx (MatrixMarket) or .vf (View3D): --rows "
             "says\n"
             "what its rows reflect and emit, and the light goes to a .csv.\n\n"
             "Examples:\n"
             "  radiosity solve data/cornell-box.obj -o cornell.h5\n"
             "  radiosity solve cornell.h5 -o lit.glb -o cornell.vtp\n"
             "  radiosity solve room.glb -o baked.glb --lightmap baked.exr --lightmap-size 2048\n"
             "  radiosity solve cornell.h5 --set white.reflectance=.9\n"
             "  radiosity solve cornell.h5 --basis surfaces\n"
             "  radiosity solve cornell.h5 --mix lamp/light=0.5 -o dim.glb\n"
             "  radiosity solve plates.mtx --areas areas.txt --rows rows.csv -o light.csv";
    case Command::gather:
      return "Files (-o): .h5 (results), .png (exposed, sRGB), .exr and .hdr (radiance, W/m^2/sr,\n"
             "linear), .glb (lit mesh). A results file given as input is updated in place where no "
             "-o is given;\n"
             "its mesh is reused, and so is the light gathered in it before. Reaching the limit "
             "of\n"
             "--passes is no failure.\n\n"
             "Examples:\n"
             "  radiosity gather data/cornell-box.obj --passes 8 -o gathered.h5 -o gathered.png\n"
             "  radiosity gather cornell.h5 --at patches --resolution 128";
    case Command::heat:
      return "Files (-o): .csv (by surface), .h5 (results), .vtp (patches, for ParaView). A "
             "results "
             "file\n"
             "given as input is updated in place where no -o is given; its form factors are "
             "reused.\n"
             "Every surface needs an emissivity and a condition: a temperature, a net flux or "
             "power,\n"
             "or convection. Net flux is above 0 where a surface gives off heat. Without "
             "conditions\n"
             "those that a results file was made with hold. SCENE may be a matrix of any program,\n"
             ".mtx (MatrixMarket) or .vf (View3D, with emissivities): conditions by name or "
             "number\n"
             "of its rows, from 1; figures go to a .csv.\n\n"
             "Examples:\n"
             "  radiosity heat oven.obj --thermal oven.csv -o oven.h5 -o surfaces.csv\n"
             "  radiosity heat oven.h5 --thermal oven.csv --condition heater.power=900\n"
             "  radiosity heat oven.h5 -o again.csv\n"
             "  radiosity heat oven.h5 --grid floor:1.1 --point-table radiant.csv\n"
             "  radiosity heat enclosure.vf --condition 1.temperature=550 --condition '*.flux=0'\n"
             "  radiosity heat plate.stl --condition '*.emissivity=0.9' --condition '*.flux=100'\n"
             "             --sky-temperature 255 -o plate.vtp";
    case Command::compare:
      return "A and B: results files (.h5), meshes with vertex colours of any program (.glb, "
             ".ply,\n"
             ".obj), both; or two pictures. Meshes may differ: a point's counterpart is the "
             "nearest\n"
             "one of the other side that faces alike; means over A's cells are compared, W/m^2.\n"
             "Or form factors, row for row: .mtx (MatrixMarket), .vf (View3D), with "
             "--form-factors\n"
             "results files. Options of scene, mesh, form factors, solution and gathering go with\n"
             "--gather.\n"
             "Files (-o): .png (the difference in false colour); with --gather also .h5 "
             "(results).\n"
             "Exit code 1: the difference is above --tolerance.\n\n"
             "Examples:\n"
             "  radiosity compare cornell.h5 --gather -o gap.png\n"
             "  radiosity compare cornell.h5 data/cornell-box-cycles.ply --b-is radiance\n"
             "  radiosity compare new.exr old.exr --tolerance 1e-3 -o difference.png\n"
             "  radiosity compare cornell.h5 cornell.vf --tolerance 1e-4";
    case Command::render:
      return "Files (-o): .png (exposed, sRGB), .exr and Radiance's .hdr (radiance, W/m^2/sr, "
             "linear),\n"
             ".glb (lit mesh), .h5 (results), .mtx (MatrixMarket); .xml (Mitsuba 3) and .pbrt "
             "(pbrt-v4),\n"
             "the scene itself for those programs, seen by the same camera. With --show an .exr "
             "holds the\n"
             "quantity itself.\n\n"
             "Examples:\n"
             "  radiosity render data/cornell-box.obj -o cornell.png\n"
             "  radiosity render cornell.h5 --exposure 2.5 --width 1024 --height 1024 -o "
             "cornell.exr\n"
             "  radiosity render cornell.h5 --show illuminance --range 0,500 -o lux.png\n"
             "  radiosity render cornell.h5 --layers -o cornell.exr\n"
             "  radiosity render data/cornell-box.obj -o cornell.xml -o cornell.pbrt\n"
             "  radiosity render cornell.h5 --show form-factor:12 -o seen-from-12.png\n"
             "  radiosity render room.glb --camera 'eye=1,1.6,3;target=0,1,0' -o room.png -o "
             "room.h5";
    case Command::illuminance:
      return "Files (-o): .csv (points: lux, direct, indirect, cylindrical, semicylindrical, on a "
             "cube;\n"
             "W/m^2 a band), .png (plans of the grids: values, lines, colours), .h5 (results).\n"
             "Printed of each set: minimum, mean, maximum, uniformity U0 and Ud. A watt of three "
             "bands\n"
             "is 683 lm times its luminance (Rec. 709); one band is grey. Points in bodies are "
             "counted\n"
             "and left out of the figures.\n\n"
             "Examples:\n"
             "  radiosity illuminance data/cornell-box.obj --grid floor:0.1 -o floor.csv -o "
             "floor.png\n"
             "  radiosity illuminance office.glb --light point,2000lm,at=2,1.5,2.4\n"
             "             --grid floor:.8:.5 --grid 'wall*' -o office.png\n"
             "  radiosity illuminance cornell.h5 --plane .1,.1,.1:.1,.1,.4:.4,.1,.4:.05\n"
             "  radiosity illuminance cornell.h5 --points desks.csv -o desks-lit.csv";
    case Command::view:
      break;
  }
  return "Files (-o): .html (the page: one file, which needs no server and no network), .h5\n"
         "(results). Where no .html is named it is the scene's name in this folder, and opens in "
         "the\n"
         "browser where there is a desktop. The page keeps form factors, between up to 8,000\n"
         "patches, or else 2,000 nodes of patches, in 16 bits each: the report says how large\n"
         "their error is.\n\n"
         "Examples:\n"
         "  radiosity view data/cornell-box.obj\n"
         "  radiosity view cornell.h5 -o cornell.html\n"
         "  radiosity view data/furnished-room.obj --patches 4000 -o room.html -o room.h5";
}

}  // namespace radiosity::cli
