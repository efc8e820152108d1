#!/usr/bin/env python3
"""Drives a window of $DISPLAY as a user does: keys, mouse, size. Needs libX11 alone.

press_keys.py TITLE STEP...   TITLE: how the window's title begins; it is waited for. Steps:
  key F5          pressed and let go        down w, up w    held until let go
  move X Y        the cursor                click X Y       left button there
  size W H        of the window             wait SECONDS
  minimise        as a window manager says  restore
  file PATTERN    waits until a file is there
  take A B        the same, and renames it
  seen FILE       what the X server shows of the window, as a .ppm
  io FILE         copies /proc/$DIVE/io: bytes that the program has written so far
Ends with 1 and a line if something does not come within 60 s.
"""
import ctypes
import glob
import os
import shutil
import sys
import time

LONGEST_WAIT_S = 60.0
x11 = ctypes.CDLL("libX11.so.6")
VOID, ULONG, UINT, INT = ctypes.c_void_p, ctypes.c_ulong, ctypes.c_uint, ctypes.c_int
x11.XOpenDisplay.restype = VOID
x11.XDefaultRootWindow.restype = ULONG
x11.XDefaultRootWindow.argtypes = [VOID]
x11.XStringToKeysym.restype = ULONG
x11.XKeysymToKeycode.argtypes = [VOID, ULONG]
x11.XKeysymToKeycode.restype = ctypes.c_ubyte
x11.XQueryTree.argtypes = [VOID, ULONG, VOID, VOID, VOID, VOID]
x11.XFetchName.argtypes = [VOID, ULONG, VOID]
x11.XSendEvent.argtypes = [VOID, ULONG, INT, ctypes.c_long, VOID]
x11.XWarpPointer.argtypes = [VOID, ULONG, ULONG, INT, INT, UINT, UINT, INT, INT]
x11.XSetInputFocus.argtypes = [VOID, ULONG, INT, ULONG]
x11.XResizeWindow.argtypes = [VOID, ULONG, UINT, UINT]
x11.XSync.argtypes = [VOID, INT]
x11.XGetImage.argtypes = [VOID, ULONG, INT, INT, UINT, UINT, ULONG, INT]
x11.XInternAtom.argtypes = [VOID, ctypes.c_char_p, INT]
x11.XInternAtom.restype = ULONG
x11.XChangeProperty.argtypes = [VOID, ULONG, ULONG, ULONG, INT, INT, VOID, INT]


class InputEvent(ctypes.Structure):
    """XKeyEvent and XButtonEvent, which have the same fields."""
    _fields_ = [("type", INT), ("serial", ULONG), ("send_event", INT), ("display", VOID),
                ("window", ULONG), ("root", ULONG), ("subwindow", ULONG), ("time", ULONG),
                ("x", INT), ("y", INT), ("x_root", INT), ("y_root", INT), ("state", UINT),
                ("detail", UINT), ("same_screen", INT), ("pad", ctypes.c_long * 24)]


class ErrorEvent(ctypes.Structure):
    """XErrorEvent."""
    _fields_ = [("type", INT), ("display", VOID), ("resource", ULONG), ("serial", ULONG),
                ("code", ctypes.c_ubyte), ("request", ctypes.c_ubyte), ("minor", ctypes.c_ubyte)]


class Image(ctypes.Structure):
    """The beginning of XImage."""
    _fields_ = [("width", INT), ("height", INT), ("offset", INT), ("format", INT),
                ("data", ctypes.POINTER(ctypes.c_ubyte)), ("byte_order", INT), ("unit", INT),
                ("bit_order", INT), ("pad", INT), ("depth", INT), ("bytes_per_line", INT),
                ("bits_per_pixel", INT)]


x11.XGetImage.restype = ctypes.POINTER(Image)

# Codes of the errors since they were last looked at. Without a handler Xlib ends the program.
errors = []


@ctypes.CFUNCTYPE(INT, VOID, ctypes.POINTER(ErrorEvent))
def keep_error(_, event):
    errors.append(event.contents.code)
    return 0


x11.XSetErrorHandler(keep_error)
KEY_RELEASE = 3


def wait_for(what, found):
    end = time.monotonic() + LONGEST_WAIT_S
    while time.monotonic() < end:
        got = found()
        if got:
            return got
        time.sleep(0.02)
    sys.exit(f"{what} did not come within {LONGEST_WAIT_S:g} s")


class Driver:
    def __init__(self, title):
        self.display = wait_for("the display", lambda: x11.XOpenDisplay(None))
        self.root = x11.XDefaultRootWindow(self.display)
        self.window = wait_for(f"a window '{title}'", lambda: self.find(self.root, title))
        wait_for("the focus", self.focus)

    def focus(self):
        """A window that is not shown yet refuses it."""
        errors.clear()
        x11.XSetInputFocus(self.display, self.window, 1, 0)
        x11.XSync(self.display, 0)
        return not errors

    def find(self, window, title):
        name = ctypes.c_char_p()
        if x11.XFetchName(self.display, window, ctypes.byref(name)) and name.value:
            if name.value.decode(errors="replace").startswith(title):
                return window
        root, parent = ULONG(), ULONG()
        children, count = ctypes.POINTER(ULONG)(), UINT()
        if not x11.XQueryTree(self.display, window, ctypes.byref(root), ctypes.byref(parent),
                              ctypes.byref(children), ctypes.byref(count)):
            return None
        found = [self.find(children[i], title) for i in range(count.value)]
        return next((one for one in found if one), None)

    def send(self, kind, detail, x=1, y=1):
        now = int(time.monotonic() * 1000) & 0x7FFFFFFF
        event = InputEvent(kind, 0, 0, self.display, self.window, self.root, 0, now, x, y, x, y, 0,
                           detail, 1)
        mask = {2: 1, 3: 2, 4: 4, 5: 8}[kind]
        x11.XSendEvent(self.display, self.window, 1, mask, ctypes.byref(event))
        x11.XSync(self.display, 0)
        # A key that closes the window is let go of after the window has gone.
        if errors and kind != KEY_RELEASE:
            sys.exit(f"event {kind}: X error {errors[0]}")
        errors.clear()

    def key(self, kind, name):
        keysym = x11.XStringToKeysym(name.encode())
        code = x11.XKeysymToKeycode(self.display, keysym) if keysym else 0
        if not code:
            sys.exit(f"key {name}: unknown")
        self.send(kind, code)

    def move(self, x, y):
        x11.XWarpPointer(self.display, 0, self.window, 0, 0, 0, 0, x, y)
        x11.XSync(self.display, 0)

    def write_seen(self, path):
        """The server's bytes are blue, green, red and one that says nothing."""
        root, x, y, width, height, border, depth = ULONG(), INT(), INT(), UINT(), UINT(), UINT(), UINT()
        x11.XGetGeometry(VOID(self.display), ULONG(self.window),
                         *map(ctypes.byref, (root, x, y, width, height, border, depth)))
        image = x11.XGetImage(self.display, self.window, 0, 0, width.value, height.value,
                              (1 << 64) - 1, 2).contents
        rows = bytes(image.data[:image.bytes_per_line * image.height])
        with open(path, "wb") as file:
            file.write(b"P6 %d %d 255\n" % (image.width, image.height))
            for row in range(image.height):
                texels = rows[row * image.bytes_per_line:][:4 * image.width]
                rgb = bytearray(3 * image.width)
                rgb[0::3], rgb[1::3], rgb[2::3] = texels[2::4], texels[1::4], texels[0::4]
                file.write(rgb)

    def do(self, step):
        name, *rest = step.split(maxsplit=1)
        rest = rest[0] if rest else ""
        if name == "key":
            self.key(2, rest)
            time.sleep(0.05)
            self.key(3, rest)
        elif name in ("down", "up"):
            self.key(2 if name == "down" else 3, rest)
        elif name in ("move", "click"):
            x, y = map(int, rest.split())
            self.move(x, y)
            if name == "click":
                time.sleep(0.5)  # frames in which the window sees the cursor there
                self.send(4, 1, x, y)
                time.sleep(0.5)
                self.send(5, 1, x, y)
        elif name == "size":
            width, height = map(int, rest.split())
            x11.XResizeWindow(self.display, self.window, width, height)
            x11.XSync(self.display, 0)
        elif name in ("minimise", "restore"):
            # Without a window manager: WM_STATE as one writes it (ICCCM 4.1.3.1).
            atom = x11.XInternAtom(self.display, b"WM_STATE", 0)
            state = (ULONG * 2)(3 if name == "minimise" else 1, 0)
            x11.XChangeProperty(self.display, self.window, atom, atom, 32, 0, state, 2)
            x11.XSync(self.display, 0)
        elif name == "wait":
            time.sleep(float(rest))
        elif name == "take":
            source, target = rest.split()
            wait_for(f"the file {source}", lambda: os.path.exists(source))
            os.rename(source, target)
        elif name == "seen":
            self.write_seen(rest)
        elif name == "io":
            shutil.copyfile(f"/proc/{os.environ['DIVE']}/io", rest)
        elif name == "file":
            wait_for(f"the file {rest}", lambda: glob.glob(rest))
        else:
            sys.exit(f"step '{step}': unknown")


driver = Driver(sys.argv[1])
for one in sys.argv[2:]:
    driver.do(one)
