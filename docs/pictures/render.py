"""Draws the pictures of the documentation in ParaView: pvpython render.py RESULTS PICTURES

RESULTS is what render.sh solved. A picture is one function below: what is shown, from where, in which colours.
"""
import functools
import os
import struct
import sys
import zlib

from paraview import simple
from vtkmodules.vtkImagingColor import vtkImageQuantizeRGBToIndex
from vtkmodules.vtkIOImage import vtkPNGReader

RESULTS, PICTURES = sys.argv[1:3]
SIZE = [900, 560]
SKY = [0.80, 0.86, 0.92]


def new_view(size=None, background=None):
    view = simple.CreateRenderView(ViewSize=size or SIZE, OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    view.Background = background or SKY
    return view


def look(view, eye, at, angle=60, up=(0, 0, 1)):
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp, view.CameraViewAngle = eye, at, up, angle


def opened(name):
    reader = simple.OpenDataFile(os.path.join(RESULTS, name))
    reader.UpdatePipeline()
    return reader


def flat(shown):
    """The colours of the legend and no shading of ParaView's own."""
    shown.Ambient, shown.Diffuse, shown.Specular = 1, 0, 0
    return shown


def show(source, view, array=None, of="POINTS", edges=False, cull=True, colour=None):
    shown = flat(simple.Show(source, view))
    shown.SetRepresentationType("Surface With Edges" if edges else "Surface")
    if cull:
        shown.BackfaceRepresentation = "Cull Backface"  # one looks into the room from outside
    if edges:
        shown.EdgeColor, shown.LineWidth = [0.25, 0.25, 0.25], 0.6
    if array:
        simple.ColorBy(shown, (of, array))
    else:
        shown.ColorArrayName = ["POINTS", ""]
    if colour:
        shown.AmbientColor = shown.DiffuseColor = colour
    return shown


def colours(array, lowest, highest, log=False, preset="Inferno (matplotlib)"):
    table = simple.GetColorTransferFunction(array)
    table.ApplyPreset(preset, True)
    table.RescaleTransferFunction(lowest, highest)
    if log:
        table.MapControlPointsToLogSpace()
        table.UseLogScale = 1
    table.NumberOfTableValues = 256
    return table


def legend(view, table, title, labels, at, dark=False, length=0.45):
    bar = simple.GetScalarBar(table, view)
    bar.Visibility = 1
    bar.Title, bar.ComponentTitle = title, ""
    bar.WindowLocation, bar.Position, bar.ScalarBarLength, bar.ScalarBarThickness = "Any Location", at, length, 14
    bar.TitleFontSize = bar.LabelFontSize = 15
    bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1] if dark else [1, 1, 1]
    bar.HorizontalTitle = 1
    bar.UseCustomLabels, bar.CustomLabels, bar.AddRangeLabels = 1, labels, 0
    bar.LabelFormat = bar.RangeLabelFormat = "%-#.6g" if any(x % 1 for x in labels) else "%.0f"


def words(view, text, at, size=16, dark=True):
    shown = simple.Show(simple.Text(Text=text), view)
    shown.WindowLocation, shown.Position, shown.FontSize = "Any Location", at, size
    shown.Color = [0.1, 0.1, 0.1] if dark else [1, 1, 1]


def save(name, of, size=None):
    """With at most 256 colours, which a false-colour picture hardly has and which take a third of the bytes."""
    file = os.path.join(PICTURES, name + ".png")
    simple.SaveScreenshot(file, of, ImageResolution=size or SIZE)
    reader = vtkPNGReader()
    reader.SetFileName(file)
    few = vtkImageQuantizeRGBToIndex()
    few.SetInputConnection(reader.GetOutputPort())
    few.SetNumberOfColors(256)
    few.Update()
    width, height = few.GetOutput().GetDimensions()[:2]
    pixels, table = reader.GetOutput().GetPointData().GetScalars(), few.GetLookupTable()
    palette = [tuple(round(255 * part) for part in table.GetTableValue(i)[:3])
               for i in range(table.GetNumberOfTableValues())]

    @functools.lru_cache(None)
    def nearest(*colour):  # the index that VTK gives is another one here and there
        return min(range(len(palette)), key=lambda i: sum((a - b) ** 2 for a, b in zip(palette[i], colour)))

    rows = b"".join(b"\0" + bytes(nearest(*pixels.GetTuple(y * width + x)[:3]) for x in range(width))
                    for y in reversed(range(height)))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(file, "wb") as png:
        png.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)) +
                  chunk(b"PLTE", bytes(sum(palette, ()))) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
    print(name, os.path.getsize(file) // 1000, "kB")


def house():
    view = new_view()
    show(opened("house.vtp"), view, "illuminance")
    look(view, [8.35, 0.75, 1.65], [1.9, 2.35, 1.0], 68)
    table = colours("illuminance", 80, 3000, log=True)
    legend(view, table, "lux", [100, 200, 500, 1000, 2000], [0.90, 0.50])
    save("house", view)


def daylight():
    view = new_view()
    show(opened("office_march.vtp"), view, "illuminance")
    look(view, [2.75, 5.9, 1.7], [1.6, 0.0, 0.95], 62)
    table = colours("illuminance", 300, 60000, log=True)
    legend(view, table, "lux", [500, 1000, 2000, 5000, 10000, 20000, 50000], [0.88, 0.50])
    save("daylight", view)


def classroom():
    view = new_view()
    show(opened("classroom.vtp"), view, "illuminance")
    look(view, [8.75, 6.6, 1.75], [2.6, 2.4, 1.05], 66)
    table = colours("illuminance", 0, 700)
    legend(view, table, "lux", [0, 100, 200, 300, 400, 500, 600, 700], [0.90, 0.47])
    save("luminaires", view)


def light_shelf():
    view = new_view()
    show(opened("light_shelf.vtp"), view, "illuminance")
    shelf = simple.Plane(Origin=[0.5, 0.02, 1.6], Point1=[3.5, 0.02, 1.6], Point2=[0.5, 0.62, 1.6])
    show(shelf, view, cull=False, colour=[0.88, 0.92, 0.96])  # mirrors are in no result: nothing stays on them
    look(view, [2.75, 5.9, 1.3], [1.75, 0.0, 1.5], 66)
    table = colours("illuminance", 300, 60000, log=True)
    legend(view, table, "lux", [500, 1000, 2000, 5000, 10000, 20000, 50000], [0.88, 0.50])
    save("light_shelf", view)


CORNELL = [0.42, 0.80, 0.98], [0.275, -0.29, 0.20]  # from above, without the ceiling, whose back one sees


def accuracy():
    layout = simple.CreateLayout("accuracy")
    size = [900, 400]
    views = [new_view([450, 400], [1, 1, 1]) for _ in range(2)]
    simple.AssignViewToLayout(views[0], layout)
    layout.SplitHorizontal(0, 0.5)
    simple.AssignViewToLayout(views[1], layout, hint=2)
    layout.SetSize(*size)
    layout.SeparatorWidth = 0
    for view, name in zip(views, ("draft", "standard")):
        show(opened("cornell_%s.vtp" % name), view, "illuminance", edges=True)
        look(view, *CORNELL, 42)
        words(view, name, [0.44, 0.93], 15)
    table = colours("illuminance", 0, 250, preset="Viridis (matplotlib)")
    simple.GetScalarBar(table, views[0]).Visibility = 0
    legend(views[1], table, "lux", [0, 50, 100, 150, 200, 250], [0.86, 0.05], dark=True, length=0.3)
    save("accuracy", layout, size)


def material(source, name):
    """Its number in the result."""
    names = source.GetClientSideObject().GetOutputDataObject(0).GetFieldData().GetAbstractArray("material_names")
    return [names.GetValue(i) for i in range(names.GetNumberOfValues())].index(name)


def models():
    view = new_view(background=[1, 1, 1])
    patches = opened("house_patches.vtp")
    show(patches, view, "material", of="CELLS", edges=True, cull=False)
    look(view, [19.5, -10.5, 10.5], [4.6, 3.0, 1.4], 36)
    paint = {"grass": (0.68, 0.78, 0.56), "facade": (0.93, 0.86, 0.74), "concrete": (0.72, 0.74, 0.76),
             "reveal": (1.0, 0.98, 0.94), "wall": (0.96, 0.93, 0.88), "ceiling": (0.98, 0.98, 0.98),
             "parquet": (0.80, 0.62, 0.44), "wood": (0.62, 0.44, 0.30), "fabric": (0.55, 0.62, 0.74),
             "white": (1.0, 1.0, 1.0)}
    table = simple.GetColorTransferFunction("material")
    table.InterpretValuesAsCategories = 1
    table.Annotations = [text for name in paint for text in (str(material(patches, name)), name)]
    table.IndexedColors = [part for colour in paint.values() for part in colour]
    simple.GetScalarBar(table, view).Visibility = 0
    save("models", view)


def links():
    view = new_view(background=[1, 1, 1])
    show(opened("elements.vtp"), view, "illuminance")
    lines = show(opened(os.path.join("debug", "links.vtp")), view, cull=False, colour=[1, 0.6, 0.3])
    lines.LineWidth, lines.Opacity = 1, 0.7
    look(view, *CORNELL, 38)
    table = colours("illuminance", 0, 250, preset="Viridis (matplotlib)")
    legend(view, table, "lux", [0, 50, 100, 150, 200, 250], [0.86, 0.08], dark=True, length=0.3)
    save("links", view)


def results():
    view = new_view(background=[1, 1, 1])
    office = opened("office.vtp")
    facade = material(office, "facade")
    inside = simple.Threshold(Input=office, Scalars=["CELLS", "material"], LowerThreshold=facade, UpperThreshold=facade,
                              ThresholdMethod="Between", Invert=1)
    below = simple.Clip(Input=inside, ClipType="Plane", Invert=1)
    below.ClipType.Origin, below.ClipType.Normal = [2, 3, 2.35], [0, 0, 1]
    show(below, view, "daylight_factor")
    rows = simple.CSVReader(FileName=[os.path.join(RESULTS, "office.sensors.csv")])
    points = simple.TableToPoints(Input=rows, XColumn="x", YColumn="y", ZColumn="z")
    sensors = simple.Calculator(Input=points, ResultArrayName="daylight_factor", Function="illuminance / 100")
    dots = show(sensors, view, "daylight_factor", cull=False)
    dots.SetRepresentationType("Points")
    dots.PointSize, dots.RenderPointsAsSpheres = 7, 1
    look(view, [6.3, 9.8, 7.8], [2.2, 2.9, 0.6], 38)
    table = colours("daylight_factor", 0.3, 20, log=True)
    legend(view, table, "daylight factor, %", [0.5, 1, 2, 5, 10, 20], [0.08, 0.06], dark=True)
    save("results", view)


def main():
    wanted = sys.argv[3:]
    for draw in (house, daylight, classroom, light_shelf, accuracy, models, links, results):
        if not wanted or draw.__name__ in wanted:
            draw()
            simple.ResetSession()


main()
