"""Opens results in ParaView as a user does, and holds them against known numbers: pvpython open_results.py FOLDER

FOLDER has furnace, cornell_box and office, of each the .vtp and the report. The program writes no collections, but users
make them of several results: a .vtm shows them together, a .pvd one after another.
"""
import glob
import json
import math
import os
import sys

from paraview import servermanager, simple
from vtkmodules.vtkIOImage import vtkPNGReader

FOLDER = sys.argv[1]
CHANNELS = {"furnace": 1, "cornell_box": 3, "office": 1}
COLLECTED = ("furnace", "office")  # with as many channels: ParaView warns of others
LIGHT = ("irradiance", "illuminance", "radiosity", "luminance")
CELLS_ONLY = ("material", "surface", "level", "area")


def in_folder(name):
    return os.path.join(FOLDER, name)


def expect(good, *what):
    if not good:
        sys.exit("ParaView: " + " ".join(map(str, what)))


def values(arrays, name, components, count):
    """All numbers of an array, which has so many tuples of so many components."""
    array = arrays.GetArray(name)
    expect(array, name, "is missing")
    shape = array.GetNumberOfTuples(), array.GetNumberOfComponents()
    expect(shape == (count, components), name, "has", shape, "and not", (count, components), "tuples and components")
    numbers = [array.GetComponent(i, c) for i in range(count) for c in range(components)]
    expect(all(map(math.isfinite, numbers)), name, "is not finite everywhere")
    return numbers


def check_result(name, data):
    with open(in_folder(name + ".json")) as file:
        report = json.load(file)
    cells, points = data.GetNumberOfCells(), data.GetNumberOfPoints()
    expect(cells == report["counts"]["elements"] > 0, name, "has", cells, "cells, the report", report["counts"])
    for arrays, count in ((data.GetCellData(), cells), (data.GetPointData(), points)):
        light = {of: values(arrays, of, CHANNELS[name] if of in ("irradiance", "radiosity") else 1, count) for of in LIGHT}
        if name == "furnace":  # closed, all alike: B = M / (1 - rho) = 500, and E = (B - M) / rho = 500
            for B in light["irradiance"] + light["radiosity"]:
                expect(abs(B - 500) < 0.5, "the furnace has", B, "W/m2 and not 500")
        if name == "office":  # under a sky of 10,000 lux
            for lux, share in zip(light["illuminance"], values(arrays, "daylight_factor", 1, count)):
                expect(abs(share - lux / 100) <= 1e-5 * lux, lux, "lux are not", share, "% of 10,000")
    of_cells = {of: values(data.GetCellData(), of, 1, cells) for of in CELLS_ONLY}
    named = data.GetFieldData().GetAbstractArray("material_names").GetNumberOfValues()
    expect(max(of_cells["material"]) < named, name, "has", named, "names of materials only")
    print("%s: %d cells, %d points" % (name, cells, points))


def opened(file):
    """What File > Open and Apply give."""
    reader = simple.OpenDataFile(in_folder(file))
    expect(reader, file, "is not opened")
    reader.UpdatePipeline()
    return reader


def check_together():
    with open(in_folder("all.vtm"), "w") as file:
        file.write('<VTKFile type="vtkMultiBlockDataSet" version="1.0"><vtkMultiBlockDataSet>\n')
        for i, name in enumerate(COLLECTED):
            file.write('<DataSet index="%d" name="%s" file="%s.vtp"/>\n' % (i, name, name))
        file.write("</vtkMultiBlockDataSet></VTKFile>\n")
    data = servermanager.Fetch(opened("all.vtm"))
    for i, name in enumerate(COLLECTED):
        check_result(name, data.GetBlock(i))


def check_one_after_another():
    with open(in_folder("times.pvd"), "w") as file:
        file.write('<VTKFile type="Collection" version="0.1"><Collection>\n')
        for i, name in enumerate(COLLECTED):
            file.write('<DataSet timestep="%d" file="%s.vtp"/>\n' % (i, name))
        file.write("</Collection></VTKFile>\n")
    reader = opened("times.pvd")
    expect(list(reader.TimestepValues) == list(range(len(COLLECTED))), "times.pvd has times", reader.TimestepValues)
    for time, name in enumerate(COLLECTED):
        reader.UpdatePipeline(time)
        check_result(name, servermanager.Fetch(reader))


def check_picture(reader):
    """Saves a look into the room in the colours of its illuminance: a share of the picture, in many colours."""
    view = simple.CreateRenderView(ViewSize=[400, 300], OrientationAxesVisibility=0)
    shown = simple.Show(reader, view, BackfaceRepresentation="Cull Backface")
    simple.ColorBy(shown, ("POINTS", "illuminance"))
    simple.ResetCamera(view)
    simple.SaveScreenshot(in_folder("picture.png"), view)
    png = vtkPNGReader()
    png.SetFileName(in_folder("picture.png"))
    png.Update()
    pixels = png.GetOutput().GetPointData().GetScalars()
    colours = [pixels.GetTuple(i) for i in range(pixels.GetNumberOfTuples())]
    share = sum(colour != colours[0] for colour in colours) / len(colours)
    different = len(set(colours))
    expect(share > 0.1 and different > 100, "picture.png is blank: %.0f %% in %d colours" % (100 * share, different))
    print("picture.png: %.0f %% in %d colours" % (100 * share, different))


def check_expat():
    """It is the updated one, which lies beside ParaView where the system has an older one (get_paraview.sh)."""
    with open("/proc/self/maps") as maps:
        loaded = {line.split()[-1] for line in maps if "/libexpat.so" in line}
    beside = {os.path.realpath(file) for folder in os.environ["LD_LIBRARY_PATH"].split(":")
              for file in glob.glob(os.path.join(folder, "libexpat.so.1"))}
    expect(loaded and (not beside or loaded == beside), "loaded", loaded, "and not", beside)
    print("read with", *loaded)


for result in CHANNELS:
    check_result(result, servermanager.Fetch(opened(result + ".vtp")))
check_together()
check_one_after_another()
check_picture(opened("cornell_box.vtp"))
check_expat()
