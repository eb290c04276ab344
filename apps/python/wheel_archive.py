"""Reads and writes wheels: zip files whose list of contents, RECORD, has the checksum of every other file."""

import base64
import hashlib
import zipfile

PROGRAM = 0o100755
DATA = 0o100644


def read(path):
    """The files of a wheel by their name: (content, mode). Its RECORD, which write() makes, is not among them."""
    with zipfile.ZipFile(path) as archive:
        return {entry.filename: (archive.read(entry), entry.external_attr >> 16 or DATA) for entry in archive.infolist()
                if not entry.is_dir() and not entry.filename.endswith(".dist-info/RECORD")}


def description_folder(files):
    """The folder NAME-VERSION.dist-info of a wheel."""
    (folder,) = {name.split("/")[0] for name in files if name.split("/")[0].endswith(".dist-info")}
    return folder


def write(path, files):
    """Writes files as read() returns them, compressed as far as the format of wheels allows."""
    record = f"{description_folder(files)}/RECORD"
    rows = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        def add(name, content, mode):
            entry = zipfile.ZipInfo(name)  # of 1980, so that the same files make the same wheel
            entry.external_attr = mode << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content, compresslevel=9)

        for name, (content, mode) in sorted(files.items()):
            add(name, content, mode)
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            rows.append(f"{name},sha256={digest},{len(content)}\n")
        add(record, "".join([*rows, f"{record},,\n"]).encode(), DATA)
