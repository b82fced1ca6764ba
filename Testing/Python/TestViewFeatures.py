# SPDX-FileCopyrightText: Copyright (c) Penumbra contributors
# SPDX-License-Identifier: BSD-3-Clause
"""In ParaView's render view, shadows change the pixels of the floor that lie in shadow, and no other pixel.

Each case draws the same view twice, the receiver as 'Surface' and as 'Soft Shadow Receiver'. Which pixels lie in
shadow is known from the filter RadianceMap and the camera alone.
"""
import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCollection
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkPNGReader

from penumbra_testing import (
    PLAIN, SHADOWED, SPHERE_CENTER, SPHERE_RADIUS, Checks, bake, cell_array, find_pass, grid_points, image_bytes,
    image_of_window, make_scene, make_view, output_path, picture,
    translate)

# Pixels next to a silhouette mix two surfaces.
SILHOUETTE = 2
# FXAA looks along an edge for its ends, 12 steps either way.
FXAA_REACH = 14
# Of 480 000: what rounding may do to a picture.
FEW_PIXELS = 20

checks = Checks()


class ShadowOnScreen:
    """Where the shadow on the floor is in a view's picture."""

    def __init__(self, scene, view):
        (grid,) = bake([scene.receiver], [scene.sphere], [scene.light])
        self.visibility = cell_array(grid, "Visibility")
        self.corners = grid_points(grid)
        self.set_pixels(view)

    def set_pixels(self, view):
        """Finds the floor's texel behind each pixel, and whether the sphere hides it."""
        near, far = unproject(view)
        ray = far - near
        to_floor = -near[..., 2:] / ray[..., 2:]
        u, v = self.texel_coordinates(near + to_floor * ray)
        rows, columns = self.visibility.shape
        self.on_floor = (u >= 0) & (u < columns) & (v >= 0) & (v < rows) & (to_floor[..., 0] > 0)
        self.column = numpy.clip(u, 0, columns - 1).astype(int)
        self.row = numpy.clip(v, 0, rows - 1).astype(int)
        self.is_hidden = hits_sphere(near, ray)

    def texel_coordinates(self, points):
        corner = self.corners[0, 0]
        rows, columns = self.visibility.shape
        edges = (self.corners[0, -1] - corner, columns), (self.corners[-1, 0] - corner, rows)
        return [((points - corner) @ edge) / (edge @ edge) * count for edge, count in edges]

    def at_pixels(self, texels):
        return texels[self.row, self.column]

    def lit(self, margin):
        """Pixels that no shadow comes near to: the texture's filter reaches to neighbouring texels, `margin` pixels
        more are the view's business."""
        near_shadow = grow(self.visibility < 1, 2)
        return ~grow(self.at_pixels(near_shadow) & self.on_floor, margin)

    def dark(self, margin):
        """Pixels of the floor that get less than half of the light, well away from any that get more."""
        deep = ~grow(self.visibility >= 0.5, 2)
        shown = self.on_floor & ~self.is_hidden
        return ~grow(~(self.at_pixels(deep) & shown), margin)

    def expected(self, plain):
        """The picture with shadows, and how far off each pixel may be: rounding of three pictures to bytes, and what
        visibility varies by within the reach of the texture's filter."""
        lightest = neighbourhood(self.visibility, 2, numpy.maximum)
        darkest = neighbourhood(self.visibility, 2, numpy.minimum)
        middle = self.at_pixels((lightest + darkest) / 2)[..., None]
        reach = self.at_pixels((lightest - darkest) / 2)[..., None]
        return plain * middle, plain * reach + 1.5


def unproject(view):
    """The points of the near and the far plane behind each pixel's centre, in world coordinates."""
    width, height = view.ViewSize
    matrix = vtkMatrix4x4()
    camera = view.GetActiveCamera()
    matrix.DeepCopy(camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1))
    matrix.Invert()
    inverse = numpy.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])
    y, x = numpy.mgrid[0:height, 0:width]
    for depth in (-1.0, 1.0):
        clip = numpy.stack(
            [(2 * x + 1) / width - 1, (2 * y + 1) / height - 1, numpy.full(x.shape, depth), numpy.ones(x.shape)], -1)
        world = clip @ inverse.T
        yield world[..., :3] / world[..., 3:]


def hits_sphere(start, ray):
    to_center = numpy.array(SPHERE_CENTER) - start
    closest = (to_center * ray).sum(-1, keepdims=True) / (ray * ray).sum(-1, keepdims=True)
    return numpy.linalg.norm(to_center - closest * ray, axis=-1) < SPHERE_RADIUS


def neighbourhood(values, reach, combine):
    """`combine` (minimum, maximum, or) over the square of `reach` neighbours around each value."""
    for axis in (0, 1):
        padded = numpy.pad(values, [(reach, reach) if i == axis else (0, 0) for i in (0, 1)], mode="edge")
        slices = numpy.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=axis)
        values = combine.reduce(slices, axis=-1)
    return values


def grow(mask, reach):
    return neighbourhood(mask, reach, numpy.logical_or)


def draw_both(shown):
    shown.receiver.Representation = PLAIN
    plain = picture(shown.view)
    shown.receiver.Representation = SHADOWED
    return plain, picture(shown.view)


def compare(name, scene, shown, margin=SILHOUETTE, covered=None):
    """Shadows change pixels in shadow, and only those; in `covered` pixels something else is drawn over the floor."""
    plain, shadowed = draw_both(shown)
    where = ShadowOnScreen(scene, shown.view)
    different = (plain != shadowed).any(-1)
    dark = where.dark(SILHOUETTE)
    if covered is not None:
        dark &= ~covered
    lit = where.lit(margin)
    darker = shadowed.astype(int).sum(-1) < plain.astype(int).sum(-1)
    checks.at_least(dark.sum(), 200, f"{name}: pixels well in the shadow")
    checks.at_most((different & lit).sum(), 0, f"{name}: pixels changed, of {lit.sum()} out of the shadow")
    checks.at_most((dark & ~darker).sum(), 0, f"{name}: pixels not darker, of {dark.sum()} in the shadow")
    return plain, shadowed


def check_numbers():
    """Where nothing else takes part, a pixel is its plain shade times the visibility."""
    scene = make_scene()
    shown = make_view(scene)
    plain, shadowed = compare("default view", scene, shown)
    where = ShadowOnScreen(scene, shown.view)
    expected, tolerance = where.expected(plain.astype(float))
    floor = ~grow(~(where.on_floor & ~where.is_hidden), SILHOUETTE)
    excess = (numpy.abs(shadowed - expected) - tolerance)[floor].max()
    checks.at_most(excess, 0, "shade off plain shade times visibility, past the tolerance, in levels of 255")


def check_parallel_projection():
    scene = make_scene()
    shown = make_view(scene)
    shown.view.CameraParallelProjection = 1
    shown.view.CameraParallelScale = 6
    compare("parallel projection", scene, shown)


def check_annotations():
    scene = make_scene()
    scene.receiver.Input = simple.Elevation(Input=scene.floor, LowPoint=[-5, -5, 0], HighPoint=[5, 5, 0])
    shown = make_view(scene)
    shown.view.OrientationAxesVisibility = 1
    shown.view.AxesGrid.Visibility = 1
    simple.ColorBy(shown.receiver, ("POINTS", "Elevation"))
    shown.receiver.SetScalarBarVisibility(shown.view, True)
    plain, _ = compare("orientation axes, axes grid, scalar bar, scalar colours", scene, shown)
    checks.at_least(len(numpy.unique(plain.reshape(-1, 3), axis=0)), 100, "colours of the plain picture")


def check_colour():
    scene = make_scene()
    shown = make_view(scene)
    shown.receiver.DiffuseColor = [0.9, 0.3, 0.1]
    shown.receiver.AmbientColor = [0.9, 0.3, 0.1]
    compare("a coloured receiver", scene, shown)
    shown.receiver.Specular = 0.5
    shown.receiver.Ambient = 0.2
    compare("a receiver with specular and ambient shade", scene, shown)


def check_image_space_effects():
    scene = make_scene()
    shown = make_view(scene)
    shown.view.UseFXAA = 1
    compare("FXAA", scene, shown, margin=FXAA_REACH)
    shown.view.UseAmbientOcclusion = 1
    compare("FXAA and ambient occlusion", scene, shown, margin=FXAA_REACH)
    shown.view.UseFXAA = 0
    compare("ambient occlusion", scene, shown)
    shown.view.UseToneMapping = 1
    compare("ambient occlusion and tone mapping", scene, shown)


def check_translucency():
    scene = make_scene()
    shown = make_view(scene)
    shown.receiver.Opacity = 0.5
    compare("a translucent receiver", scene, shown)
    shown.receiver.Opacity = 1
    shown.occluder.Opacity = 0.3
    compare("a translucent occluder", scene, shown)
    shown.receiver.Opacity = 0.5
    compare("receiver and occluder translucent", scene, shown)


def pick(view, rectangle):
    """What hardware picking finds in a rectangle: the sources' kinds with the ids of their cells."""
    representations, selections = vtkCollection(), vtkCollection()
    view.SMProxy.SelectSurfaceCells(rectangle, representations, selections, False)
    found = []
    for i in range(representations.GetNumberOfItems()):
        source = representations.GetItemAsObject(i).GetProperty("Input").GetProxy(0)
        ids = servermanager._getPyProxy(selections.GetItemAsObject(i)).IDs
        found.append((source.GetXMLName(), tuple(ids)))
    return found


def check_selection():
    scene = make_scene()
    shown = make_view(scene)
    width, height = shown.view.ViewSize
    for wanted, source, rectangle in (
        ("ShadowReceiver", scene.receiver, [width // 8, height // 4, width // 3, height // 2]),
        ("SphereSource", scene.sphere, [width // 2 - 8, height * 6 // 10, width // 2 + 8, height * 6 // 10 + 12])):
        shown.receiver.Representation = PLAIN
        bare = picture(shown.view)
        picked = pick(shown.view, rectangle)
        checks.equal([name for name, _ in picked], [wanted], "picked")
        simple.SelectSurfaceCells(Rectangle=rectangle, View=shown.view)
        covered = grow((picture(shown.view) != bare).any(-1), 1)
        checks.at_least(covered.sum(), 50, f"pixels that show the selection on {wanted}")
        compare(f"cells selected on {wanted}", scene, shown, covered=covered)
        checks.check(pick(shown.view, rectangle) == picked, f"with shadows, the same cells are picked on {wanted}")
        simple.ClearSelection(source)


def check_plain_cases():
    """Wherever there is nothing to show, the view draws as if the plugin were not there."""
    scene = make_scene()
    untouched = make_view(scene)
    untouched.receiver.Representation = PLAIN
    plain = picture(untouched.view)
    shown = make_view(scene)
    checks.check((picture(shown.view) != plain).any(), "the shadow is there")
    shown.receiver.Representation = PLAIN
    checks.check((picture(shown.view) == plain).all(), "switched back to Surface, the view is plain")
    untouched.receiver.Representation = shown.receiver.Representation = "Surface With Edges"
    edges = picture(untouched.view)
    checks.check((edges != plain).any(), "Surface With Edges shows edges")
    checks.check((picture(shown.view) == edges).all(), "Surface With Edges is plain")
    untouched.receiver.Representation, shown.receiver.Representation = PLAIN, SHADOWED
    simple.Hide(scene.light, shown.view)
    simple.Hide(scene.light, untouched.view)
    checks.check((picture(shown.view) == picture(untouched.view)).all(), "without a light, the view is plain")
    simple.Show(scene.light, shown.view)
    simple.Hide(scene.sphere, shown.view)
    simple.Show(scene.light, untouched.view)
    simple.Hide(scene.sphere, untouched.view)
    checks.check((picture(shown.view) == picture(untouched.view)).all(), "without an occluder, the view is plain")


def check_light_representations():
    scene = make_scene()
    shown = make_view(scene)
    lit = picture(shown.view)
    for representation in ("Wireframe", "Surface With Edges", "Points"):
        shown.light.Representation = representation
        where = ShadowOnScreen(scene, shown.view)
        same = (picture(shown.view) == lit).all(-1)[where.dark(SILHOUETTE)].all()
        checks.check(same, f"a light shown as {representation} lights as one shown as Surface")


def check_selected_light():
    """A selection is shown by an actor with a copy of the selected cells: that of a light's does not shine too."""
    scene = make_scene()
    shown = make_view(scene)
    shown.view.CameraPosition, shown.view.CameraFocalPoint = [8, -14, 14], [2, 0, 5]
    bare, wanted = picture(shown.view), first_texels(shown.view)
    width, height = shown.view.ViewSize
    middle = [width // 2 - 5, height // 2, width // 2 + 5, height // 2 + 30]
    checks.equal([name for name, _ in pick(shown.view, middle)], ["AreaLight"], "picked")
    simple.SelectSurfaceCells(Rectangle=middle, View=shown.view)
    checks.check((picture(shown.view) != bare).any(), "the selection of the light is shown")
    checks.check(first_texels(shown.view) == wanted, "the selected light shines as before")


def first_texels(view):
    view.GetRenderWindow().MakeCurrent()
    return vtk_to_numpy(find_pass(view).GetTexels(0)).tobytes()


def check_two_views():
    scene = make_scene()
    first = make_view(scene)
    alone = picture(first.view)
    second = make_view(scene, size=(320, 320))
    second.view.CameraPosition = [-12, -6, 9]
    compare("a second view", scene, second)
    checks.check((picture(first.view) == alone).all(), "the first view is drawn as when it was alone")
    both = picture(second.view)
    simple.Delete(first.view)
    checks.check((picture(second.view) == both).all(), "the second view stays as it was when the first is gone")


def check_sizes():
    scene = make_scene()
    shown, large = make_view(scene), make_view(scene, size=(800, 600))
    compare("a large view", scene, large)
    small = picture(shown.view)
    compare_screenshot(shown, large)
    checks.check((picture(shown.view) == small).all(), "after the screenshot, the view is as it was")
    shown.view.ViewSize = [800, 600]
    same = (picture(shown.view) == picture(large.view)).all()
    checks.check(same, "a resized view is as one of that size from the start")
    shown.view.ViewSize = [400, 300]
    checks.check((picture(shown.view) == small).all(), "resized back, it is as it was")


def compare_screenshot(shown, large):
    """ParaView puts a large picture together from tiles, whose projections are rounded otherwise than that of a large
    view. So a pixel on a silhouette may fall to the other surface, and where the rasteriser rounds the fraction
    between two mip levels the other way, a shade is a few levels off: both in a few pixels only."""
    plain_views = [draw_both(each)[0] for each in (shown, large)]
    shown.receiver.Representation = PLAIN
    silhouettes = (screenshot(shown.view, (800, 600)) != plain_views[1]).any(-1)
    checks.at_most(silhouettes.sum(), FEW_PIXELS, "pixels of a plain screenshot that differ from a view of its size")
    shown.receiver.Representation = SHADOWED
    difference = screenshot(shown.view, (800, 600)).astype(int) - picture(large.view)
    difference = numpy.abs(difference).max(-1)[~silhouettes]
    checks.at_most((difference > 0).sum(), FEW_PIXELS, "pixels of a screenshot that differ from a view of its size")
    checks.at_most(difference.max(), 4, "levels by which they differ")


def check_bakes():
    """Nothing but what a bake depends on makes the view bake."""
    scene = make_scene()
    shown = make_view(scene)

    def check_count(wanted, after):
        picture(shown.view)
        checks.equal(find_pass(shown.view).GetBakeCount(), wanted, f"bakes, after {after}")

    check_count(1, "the first frame")
    check_count(1, "a second frame")
    shown.view.CameraPosition = [9, -13, 7]
    check_count(1, "a move of the camera")
    shown.view.ViewSize = [500, 200]
    check_count(1, "a change of size")
    screenshot(shown.view, (800, 600))
    check_count(1, "a large screenshot")
    shown.receiver.DiffuseColor = [0.5, 0.5, 0.9]
    shown.occluder.DiffuseColor = [0.9, 0.5, 0.5]
    shown.receiver.ShadowShading = "Radiance"
    check_count(1, "changes of colour and shading")
    scene.light.Radiance = [2, 2, 2]
    check_count(2, "a change of the light")
    translate(shown.occluder, [0.5, 0, 0])
    check_count(3, "a move of the occluder")
    shown.occluder.Opacity = 0.5
    check_count(4, "the occluder has become translucent")
    check_count(4, "one more frame")


def check_texture_memory():
    """The display that allows the least memory decides for the view, and the textures stay below."""
    scene = make_scene(texel_size=7 / 512)
    shown = make_view(scene)
    wall = simple.ShadowReceiver(Input=simple.Plane(Origin=[-3, 3, 0], Point1=[3, 3, 0], Point2=[-3, 3, 4]))
    displays = [shown.receiver, simple.Show(wall, shown.view)]
    simple.Render(shown.view)
    shadows = find_pass(shown.view)
    checks.equal(shadows.GetMaximumTextureMemory(), 256, "MaximumTextureMemory in MiB, by default")
    checks.at_least(shadows.GetTextureBytes(), 512 * 512 * 16, "bytes of a floor's textures")
    for display in displays:
        display.MaximumTextureMemory = 2
        simple.Render(shown.view)
        checks.equal(shadows.GetMaximumTextureMemory(), 2, "MaximumTextureMemory, if one display says 2")
        checks.at_most(shadows.GetTextureBytes(), 2 << 20, "bytes of textures then")
        display.MaximumTextureMemory = 300
    simple.Render(shown.view)
    checks.equal(shadows.GetMaximumTextureMemory(), 300, "MaximumTextureMemory, if both say 300")
    checks.at_least(shadows.GetTextureBytes(), 512 * 512 * 16, "bytes of textures then")


def screenshot(view, resolution):
    path = output_path("TestViewFeatures.png")
    simple.SaveScreenshot(path, view, ImageResolution=resolution)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    return image_bytes(reader.GetOutput())


def check_interaction():
    """While the camera is moved, ParaView may draw coarser data; nothing is baked, and the shadow stays."""
    scene = make_scene()
    shown = make_view(scene)
    shown.view.LODThreshold = 0
    plain, shadowed = draw_both(shown)
    bakes = find_pass(shown.view).GetBakeCount()
    dark = ShadowOnScreen(scene, shown.view).dark(SILHOUETTE)
    shown.view.SMProxy.InteractiveRender()
    moving = image_of_window(shown.view)
    checks.check((moving < plain).any(-1)[dark].all(), "the shadow is there while the camera moves")
    checks.equal(find_pass(shown.view).GetBakeCount(), bakes, "bakes, after an interactive frame")
    checks.check((picture(shown.view) == shadowed).all(), "the next still frame is as before")


CASES = [value for name, value in list(globals().items()) if name.startswith("check_")]
checks.run(CASES)
