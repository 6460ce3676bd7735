.include "../../../pyproject.toml"
        HALT
