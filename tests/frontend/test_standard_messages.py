"""The definitions of common packages are valid, and the types of their fields are in them."""

from __future__ import annotations

from dataclasses import replace

from smachac.frontend.messages.message_definitions import find_definitions
from smachac.frontend.messages.standard_messages import FOLDER, standard_package
from smachac.ir.message_types import PARTS, PRIMITIVES
from tests.support.typed_machines import BUILT_IN


def test_every_definition_is_valid_and_its_types_are_known() -> None:
    library = replace(BUILT_IN, ros=1)
    for file in FOLDER.glob("*.txt"):
        for path, texts in standard_package(file.stem, 1).texts.items():
            kind = next(part for part in PARTS if path.startswith(f"{part}/"))
            found = find_definitions(f"{file.stem}/{path.partition('/')[2]}", kind, library)
            assert len(found) == len(texts), path
            for definition in found:
                for message in definition.messages:
                    for field in message.fields:
                        name = field.type.name
                        assert name in PRIMITIVES or find_definitions(name, "msg", library), name
