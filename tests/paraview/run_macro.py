"""Runs the macro of data/paraview on a result as a user does: pvpython run_macro.py MACRO RESULT.vtp PICTURE.png"""
import runpy
import sys

from paraview import servermanager, simple
from vtkmodules.vtkIOImage import vtkPNGReader

MACRO, RESULT, PICTURE = sys.argv[1:4]


def expect(good, *what):
    if not good:
        sys.exit("ParaView: " + " ".join(map(str, what)))


# As File > Open and Apply, then the macro's button.
source = simple.OpenDataFile(RESULT)
view = simple.CreateRenderView(ViewSize=[600, 400], OrientationAxesVisibility=0)
simple.SetActiveSource(source)
simple.SetActiveView(view)
sys.argv = [MACRO]
runpy.run_path(MACRO, run_name="__main__")

made = {name: proxy for (name, _), proxy in simple.GetSources().items()}
expect("Rooms" in made and "Isolux" in made, "the macro made", list(made))
shown = simple.GetDisplayProperties(made["Rooms"], view)
expect(shown.BackfaceRepresentation == "Cull Backface", "backs are shown:", shown.BackfaceRepresentation)
expect(list(shown.ColorArrayName) == ["POINTS", "illuminance"], "coloured by", list(shown.ColorArrayName))
bar = simple.GetScalarBar(simple.GetColorTransferFunction("illuminance"), view)
expect(bar.Visibility == 1 and bar.Title == "illuminance", "there is no legend")
levels = list(made["Isolux"].Isosurfaces)
lines = servermanager.Fetch(made["Isolux"])
expect(lines.GetNumberOfCells() > 10, lines.GetNumberOfCells(), "lines of equal illuminance")
for i in range(lines.GetNumberOfPoints()):
    lux = lines.GetPointData().GetArray("illuminance").GetValue(i)
    expect(min(abs(lux - level) for level in levels) <= 1e-3 * lux, "a line of", lux, "lux")

# The sum of the layers is the light; at half of each there is half of it.
lit = source.PointData["illuminance"].GetRange()
layers = made["Layers"]
summed = layers.PointData["illuminance"].GetRange()
expect(all(abs(a - b) <= 1e-4 * lit[1] for a, b in zip(lit, summed)), "the layers sum to", summed, "and the light is", lit)
layers.Function = layers.Function.replace("1*", "0.5*")
layers.UpdatePipeline()
half = layers.PointData["illuminance"].GetRange()
expect(all(abs(a / 2 - b) <= 1e-4 * lit[1] for a, b in zip(lit, half)), "at a half there is", half, "of", lit)
layers.Function = layers.Function.replace("0.5*", "1*")

simple.SaveScreenshot(PICTURE, view)
png = vtkPNGReader()
png.SetFileName(PICTURE)
png.Update()
pixels = png.GetOutput().GetPointData().GetScalars()
colours = {pixels.GetTuple(i) for i in range(pixels.GetNumberOfTuples())}
expect(len(colours) > 100, "the picture is blank: %d colours" % len(colours))
print("macro: %d parts of lines at %s lux" % (lines.GetNumberOfCells(), levels))
