#!/usr/bin/env python3
"""packaging/bill_of_materials.py DEB > FILE: what the package is made of and runs on, as SPDX 2.3
(JSON): itself with the hash of each of its files, and the Debian packages of the libraries that its
programs load on this machine, each with version and licences."""

import datetime
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# As Debian's copyright files write them, where SPDX writes them otherwise.
SPDX = {"expat": "MIT", "gpl-2+": "GPL-2.0-or-later", "gpl-2": "GPL-2.0-only",
        "gpl-3+": "GPL-3.0-or-later", "gpl-3": "GPL-3.0-only", "lgpl-2": "LGPL-2.0-only",
        "lgpl-2+": "LGPL-2.0-or-later", "lgpl-2.1": "LGPL-2.1-only",
        "lgpl-2.1+": "LGPL-2.1-or-later", "lgpl-3": "LGPL-3.0-only",
        "lgpl-3+": "LGPL-3.0-or-later", "bsd-2-clause": "BSD-2-Clause",
        "bsd-3-clause": "BSD-3-Clause", "apache-2.0": "Apache-2.0", "zlib": "Zlib", "isc": "ISC",
        "mit": "MIT", "boost-1.0": "BSL-1.0", "bsl-1.0": "BSL-1.0", "openssl": "OpenSSL"}


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def libraries(root):
    """Files that the programs and plugins of a package load, as the loader finds them."""
    found = set()
    for file in [*root.glob("usr/bin/*"), *root.glob("usr/lib/trephine/plugins/*.so")]:
        for line in output("ldd", str(file)).splitlines():
            if match := re.search(r"=> (/\S+)", line):
                found.add(os.path.realpath(match[1]))
    return sorted(found)


def owner(file):
    """The Debian package of a file; it may be listed under /lib, or under /usr/lib."""
    for name in (file, file.removeprefix("/usr")):
        done = subprocess.run(["dpkg-query", "-S", name], capture_output=True, text=True)
        if done.returncode == 0:
            return done.stdout.split(": ")[0].split(",")[0]
    return None


def licences(package):
    """The short names in its copyright file; of one that no machine reads, the texts it refers to."""
    name = package.split(":")[0]
    text = Path(f"/usr/share/doc/{name}/copyright")
    if not text.exists():
        return []
    words, names = text.read_text(errors="replace"), set()
    for line in words.splitlines():
        if match := re.match(r"License:\s*(\S.*)$", line):
            names |= {word.strip() for word in re.split(r"\s+(?:and|or|with)\s+|,", match[1])}
    if not names:
        names = set(re.findall(r"/usr/share/common-licenses/([A-Za-z0-9.-]*[A-Za-z0-9])", words))
    return sorted(names - {""})


def spdx_expression(names):
    known = [SPDX.get(name.lower()) for name in names]
    if not names or None in known:
        return "NOASSERTION"
    return " AND ".join(sorted(set(known)))


def main():
    deb = Path(sys.argv[1])
    field = lambda name: output("dpkg-deb", "-f", str(deb), name).strip()
    when = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", "0")) or
                                           deb.stat().st_mtime, datetime.timezone.utc)
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        output("dpkg-deb", "-x", str(deb), folder)
        files = [{"SPDXID": f"SPDXRef-File-{number}", "fileName": "./" + str(path.relative_to(root)),
                  "checksums": [
                      {"algorithm": "SHA1",
                       "checksumValue": hashlib.sha1(path.read_bytes()).hexdigest()},
                      {"algorithm": "SHA256",
                       "checksumValue": hashlib.sha256(path.read_bytes()).hexdigest()}],
                  "licenseConcluded": "BSD-3-Clause", "licenseInfoInFiles": ["NOASSERTION"],
                  "copyrightText": "NOASSERTION"}
                 for number, path in enumerate(sorted(root.rglob("*"))) if path.is_file()]
        packages = sorted({owner(file) for file in libraries(root)} - {None})
    own = {"SPDXID": "SPDXRef-trephine", "name": "trephine", "versionInfo": field("Version"),
           "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
           "checksums": [{"algorithm": "SHA256",
                          "checksumValue": hashlib.sha256(deb.read_bytes()).hexdigest()}],
           "licenseConcluded": "BSD-3-Clause", "licenseDeclared": "BSD-3-Clause",
           "copyrightText": "2026, the Trephine authors"}
    rows, relations = [own], [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                               "relatedSpdxElement": "SPDXRef-trephine"}]
    for package in packages:
        name, version, source = output("dpkg-query", "-W", "-f",
                                       "${Package} ${Version} ${source:Package}", package).split()
        names = licences(package)
        identity = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", name)
        rows.append({
            "SPDXID": identity, "name": name, "versionInfo": version,
            "supplier": "Organization: Debian", "sourceInfo": f"Debian source package {source}",
            "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
            "licenseConcluded": spdx_expression(names), "licenseDeclared": spdx_expression(names),
            "licenseComments": ", ".join(names) or "see the package's copyright file",
            "copyrightText": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{version}"}]})
        relations.append({"spdxElementId": "SPDXRef-trephine", "relationshipType": "DEPENDS_ON",
                          "relatedSpdxElement": identity})
    for file in files:
        relations.append({"spdxElementId": "SPDXRef-trephine", "relationshipType": "CONTAINS",
                          "relatedSpdxElement": file["SPDXID"]})
    json.dump({"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
               "name": deb.stem,
               "documentNamespace": "urn:trephine:" + hashlib.sha256(deb.read_bytes()).hexdigest(),
               "creationInfo": {"created": when.strftime("%Y-%m-%dT%H:%M:%SZ"),
                                "creators": ["Tool: trephine-bill-of-materials"]},
               "packages": rows, "files": files, "relationships": relations},
              sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    if len(sys.argv) != 2 or not Path(sys.argv[1]).is_file():
        sys.exit("usage: packaging/bill_of_materials.py DEB > FILE")
    main()
